// The normals of all faces at their corners: given, or found from the faces and tangents that meet there.
#pragma once

#include <array>
#include <vector>

#include "core/joining/edge_table.h"

namespace patchmill {

// The normal of one face at one corner.
struct CornerNormal {
  Vec3 unit = Vec3::Zero();
  // True if nothing requires this plane: no normal was given, and no other face meets this one smoothly here.
  // The patch then takes the plane of its two edges.
  bool loose = false;
};

// A group of faces (EdgeTable) without a given normal gets the angle-weighted mean of the corners' normals.
// It is corrected so that the tangents given there lie in the plane: perpendicular to one tangent, a best fit
// to several. Its sense is that of the majority and does not matter.
std::vector<std::array<CornerNormal, 4>> CornerNormals(const CurveNetwork& network, const EdgeTable& table);

}  // namespace patchmill
