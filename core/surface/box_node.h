// The node of a surface's tree of boxes, with four children, as searches walk it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/lanes.h"

namespace patchmill {

struct FourChildren;
struct SurfaceNode;

// Four children and their boxes, rounded outward to floats. In empty lanes min is above max.
struct alignas(64) BoxNode {
  Float4 min_x, min_y, min_z, max_x, max_y, max_z;
  std::int32_t child[4];  // >= 0: node, < 0: leaf ~child

  bool IsEmpty(int k) const { return !(min_x[k] <= max_x[k]); }
};

// Sets the boxes of `node` from the nodes own.binary, and its children from own.child.
void SetBoxes(const std::vector<SurfaceNode>& binary, const FourChildren& own, BoxNode& node);

}  // namespace patchmill
