// A binary tree over boxes, in depth-first order.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

// Builds the nodes over `boxes` (one per leaf, none empty). Each node is split where the surface area
// heuristic finds it cheapest, or at the median if it finds no split. The depth is at most about 2 log2(n) +
// 30. Deterministic, in parallel. Cost O(n log n), about 0.5 us per box. Returns an empty tree if `run` is
// cancelled.
std::vector<SurfaceNode> BuildLeafTree(const std::vector<Box3>& boxes, const RunContext& run);

}  // namespace patchmill
