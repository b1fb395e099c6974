// A surface's tree of boxes as searches walk it: four children a node.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/lanes.h"

namespace patchmill {

struct FourChildren;
struct SurfaceNode;

// Four children and their boxes, rounded outward to floats. Boxes of empty lanes are upside down.
struct alignas(64) BoxNode {
  Float4 min_x, min_y, min_z, max_x, max_y, max_z;
  std::int32_t child[4];  // >= 0: node, < 0: leaf ~child

  bool IsEmpty(int k) const { return !(min_x[k] <= max_x[k]); }
};

// The boxes of `own.binary` and the numbers of `own.child`.
void SetBoxes(const std::vector<SurfaceNode>& binary, const FourChildren& own, BoxNode& node);

}  // namespace patchmill
