// Triangles of a patch for a picture that changes while a hand drags. No path is planned on them.
#pragma once

#include <array>
#include <vector>

#include "core/patch/patch.h"

namespace patchmill {

struct PatchMesh {
  std::vector<Vec3> places;  // on the surface
  // Unit, along S_u x S_v; at a pole that of the surface beside it; zero where that is degenerate, too.
  std::vector<Vec3> normals;
  std::vector<std::array<int, 3>> corners;  // anticlockwise about the normals
};

// Steps of equal length in the parameters, `cells` (>= 1) along each side. Two patches that share a whole
// edge have the same places along it, to rounding. Cost: one evaluation for each place.
PatchMesh MeshOf(const PatchShape& shape, int cells);

}  // namespace patchmill
