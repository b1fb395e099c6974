// The walk of a height search. It visits the leaves that may be in the way of some balls, the most promising
// first.
#pragma once

#include <algorithm>
#include <array>
#include <bit>

#include "cam/location/search_tree.h"
#include "core/base/lanes.h"
#include "core/surface/collapse.h"

namespace patchmill::internal {

// The box in plan that holds the balls' centres.
struct XyBox {
  float x0, x1, y0, y1;
};

// How near a leaf must be, with a margin for the rounding of floats.
struct WalkLimits {
  float square;  // for the squared distance from boxes
  float radius;  // for the height above half-spaces
};

// The balls of a walk.
struct WalkedBalls {
  XyBox at;
  WalkLimits limits;
};

// Calls visit(leaf), until it returns false, for every leaf that may be in the way of a ball or its upward
// sweep. The centres of the balls lie over balls.at, at heights of lowest() (mm) or more; lowest() may rise
// from call to call. A leaf is visited if box and half-space of the leaf and of all nodes above it pass two
// tests. The box: (distance in plan)^2 + max(0, lowest - max_z)^2 < limits.square. The half-space: some
// centre over balls.at at the height lowest() is no higher above its plane than limits.radius. Of the
// children that pass, only those for which meets(node, k) is true (child k of the node) are followed.
template <class Lowest, class Meets, class Visit>
void WalkTree(const SearchTree& tree, const WalkedBalls& balls, const Lowest& lowest, const Meets& meets,
              const Visit& visit) {
  const XyBox& at = balls.at;
  const WalkLimits& limits = balls.limits;
  const float limit = limits.square;
  // A node or leaf still to be visited, its squared distance in plan and the height that it reaches.
  struct Pending {
    std::int32_t child;
    float distance2, max_z, promise;
  };
  std::array<Pending, kMaxPending> stack;
  std::size_t size = 0;
  const Float4 x0 = Splat(at.x0), x1 = Splat(at.x1), y0 = Splat(at.y0), y1 = Splat(at.y1);
  const Float4 zero = Splat(0.0F), limit4 = Splat(limit);
  float z = lowest();
  for (std::int32_t next = 0;;) {
    const SearchNode& node = tree.nodes[static_cast<std::size_t>(next)];
    const Float4 dx = Max(Max(node.min_x - x1, x0 - node.max_x), zero);
    const Float4 dy = Max(Max(node.min_y - y1, y0 - node.max_y), zero);
    const Float4 below = Max(Splat(z) - node.max_z, zero);
    const Float4 distance2 = dx * dx + dy * dy, promise = node.max_z - distance2;
    // The most promising child comes last, on top of the stack.
    const std::size_t first = size;
    const Float4 over = Min(node.up_x * x0, node.up_x * x1) + Min(node.up_y * y0, node.up_y * y1) +
                        node.up_z * Splat(z) - Splat(limits.radius);
    for (unsigned in = BelowBits(distance2 + below * below, limit4) & ~BelowBits(node.top, over); in != 0;
         in &= in - 1) {
      const int k = std::countr_zero(in);
      if (!meets(node, k)) continue;
      const Pending p{node.child[k], distance2[k], node.max_z[k], promise[k]};
      tree.Prefetch(p.child);
      std::size_t i = size++;
      for (; i > first && stack[i - 1].promise > p.promise; --i) stack[i] = stack[i - 1];
      stack[i] = p;
    }
    for (next = -1; next < 0;) {
      if (size == 0) return;
      const Pending& top = stack[--size];
      const float under = std::max(0.0F, z - top.max_z);
      if (top.distance2 + under * under >= limit) continue;
      if (top.child >= 0) {
        next = top.child;
      } else {
        if (!visit(~top.child)) return;
        z = lowest();
      }
    }
  }
}

template <class Lowest, class Visit>
void WalkTree(const SearchTree& tree, const WalkedBalls& balls, const Lowest& lowest, const Visit& visit) {
  WalkTree(
      tree, balls, lowest, [](const SearchNode&, int) { return true; }, visit);
}

}  // namespace patchmill::internal
