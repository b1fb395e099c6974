// The normal of every face at every corner of it: given, or found from what meets there.
#pragma once

#include <array>
#include <vector>

#include "core/joining/edge_table.h"

namespace patchmill {

// Of one face corner.
struct CornerNormal {
  Vec3 unit = Vec3::Zero();
  // Nothing asks for this plane: no normal was given, and no face meets this one smoothly here. The patch
  // takes the plane of its two edges.
  bool loose = false;
};

// A group of faces (EdgeTable) without a given normal gets the angle-weighted mean of the corners' normals,
// corrected so that the tangents given there lie in the plane: perpendicular to one, best fit to several. The
// sense is that of the majority and does not matter.
std::vector<std::array<CornerNormal, 4>> CornerNormals(const CurveNetwork& network, const EdgeTable& table);

}  // namespace patchmill
