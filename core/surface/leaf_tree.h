// A binary tree over boxes, in depth-first order.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

// Nodes over `boxes` (one per leaf, none empty), split where the surface area heuristic finds it cheapest, at
// the median where it finds nothing. Depth at most about 2 log2(n) + 30. Deterministic, in parallel; cost O(n
// log n), about 0.5 us a box. Empty when `run` is cancelled meanwhile.
std::vector<SurfaceNode> BuildLeafTree(const std::vector<Box3>& boxes, const RunContext& run);

}  // namespace patchmill
