// A walk of a surface's tree of boxes, nearer boxes first.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/surface/box_node.h"
#include "core/surface/collapse.h"

namespace patchmill {

// bound(node) returns for each child a lower bound of the squared distance of its contents. excluded(bound)
// says whether children so far away are left out; it is called again when their turn comes. leaf(number,
// max_z) is called for the remaining leaves, with the top of the leaf's box, until it returns true.
template <class Bound, class Excluded, class Leaf>
void WalkNearestFirst(const std::vector<BoxNode>& nodes, const Bound& bound, const Excluded& excluded,
                      const Leaf& leaf) {
  struct Open {
    double squared;
    std::int32_t child;
    float max_z;
  };
  std::array<Open, kMaxPending> stack;
  std::size_t size = 0;
  for (std::int32_t next = nodes.empty() ? -1 : 0; next >= 0;) {
    const BoxNode& node = nodes[static_cast<std::size_t>(next)];
    const std::array<double, 4> squared = bound(node);
    const std::size_t first = size;  // the nearest child comes last, on top of the stack
    for (int k = 0; k < 4; ++k) {
      const Open child{squared[static_cast<std::size_t>(k)], node.child[k], node.max_z[k]};
      if (excluded(child.squared) || node.IsEmpty(k)) continue;
      if (child.child >= 0) {
        const auto* at = reinterpret_cast<const char*>(&nodes[static_cast<std::size_t>(child.child)]);
        __builtin_prefetch(at);
        __builtin_prefetch(at + 64);
      }
      std::size_t i = size++;
      for (; i > first && stack[i - 1].squared < child.squared; --i) stack[i] = stack[i - 1];
      stack[i] = child;
    }
    for (next = -1; next < 0;) {
      if (size == 0) return;
      const Open& top = stack[--size];
      if (excluded(top.squared)) continue;
      if (top.child >= 0) {
        next = top.child;
      } else if (leaf(~top.child, static_cast<double>(top.max_z))) {
        return;
      }
    }
  }
}

}  // namespace patchmill
