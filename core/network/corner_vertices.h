// Merges patch corners within the join tolerance of each other into one vertex.
#pragma once

#include <vector>

#include "core/base/vec.h"

namespace patchmill {

struct CornerVertices {
  std::vector<int> vertex_of;  // of each point given
  std::vector<Vec3> position;  // of each vertex: the first point that made it
};

// Each point joins the first vertex within `tolerance`, else it makes a new one. Expected cost O(n), by a
// hash of cells in which vertices cannot crowd.
CornerVertices MergeCorners(const std::vector<Vec3>& points, double tolerance);

}  // namespace patchmill
