// A walk of a surface's tree of boxes, nearer ones first.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/status.h"
#include "core/surface/surface.h"

namespace patchmill {

// bound(node): the square of how near anything in the node may be. excluded(bound): nodes so far away are
// left out; asked again when their turn comes. leaf(node) is called for the rest of the leaves, until it
// returns true.
template <class Bound, class Excluded, class Leaf>
void WalkNearestFirst(const std::vector<SurfaceNode>& nodes, const Bound& bound, const Excluded& excluded,
                      const Leaf& leaf) {
  struct Open {
    double squared;
    std::int32_t node;
  };
  std::array<Open, 256> stack;  // BuildLeafTree: depth < 30 + log2(leaves)
  std::size_t size = 0;
  if (!nodes.empty()) stack[size++] = {bound(nodes.front()), 0};
  while (size > 0) {
    const Open open = stack[--size];
    if (excluded(open.squared)) continue;
    const SurfaceNode& node = nodes[static_cast<std::size_t>(open.node)];
    if (node.leaf >= 0) {
      if (leaf(node)) return;
      continue;
    }
    Open left{0.0, open.node + 1}, right{0.0, node.right};
    left.squared = bound(nodes[static_cast<std::size_t>(left.node)]);
    right.squared = bound(nodes[static_cast<std::size_t>(right.node)]);
    if (left.squared < right.squared) std::swap(left, right);  // the nearer one on top
    PM_CHECK(size + 2 <= stack.size());
    if (!excluded(left.squared)) stack[size++] = left;
    if (!excluded(right.squared)) stack[size++] = right;
  }
}

}  // namespace patchmill
