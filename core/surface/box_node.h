// A surface's tree of boxes as searches walk it: four children a node.
#pragma once

#include <cstdint>
#include <vector>

#include <absl/status/status.h>

#include "core/base/lanes.h"
#include "core/base/run_context.h"

namespace patchmill {

struct FourChildren;
struct SurfaceNode;

// Four children and their boxes, rounded outward to floats. Empty lanes have boxes that nothing meets.
struct alignas(64) BoxNode {
  Float4 min_x, min_y, min_z, max_x, max_y, max_z;
  std::int32_t child[4];  // >= 0: node, < 0: leaf ~child

  bool IsEmpty(int k) const { return !(min_x[k] <= max_x[k]); }
};

void SetBoxes(const std::vector<SurfaceNode>& binary, const FourChildren& own, BoxNode& node);

// nodes[0] is the root. About 150 ns a leaf, parallel. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::Status MakeBoxNodes(const std::vector<SurfaceNode>& binary, const RunContext& run,
                          std::vector<BoxNode>& nodes);

}  // namespace patchmill
