// A polygon mesh as a curve network [crossing, section 6].
#pragma once

#include <vector>

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"

namespace patchmill {

struct PolygonMesh {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces;  // of three or four corners
};

// One face for each polygon, with edges from normals. Polygons that meet at more than `crease_angle` (rad)
// have a crease between them. Points of no face are left out, and so are polygons without area or with a
// corner twice: the finding DEGENERATE_FACE. JoinNetwork finds the other faults.
CurveNetwork MeshNetwork(const PolygonMesh& mesh, double crease_angle, Diagnostics& findings);

}  // namespace patchmill
