// The tree of a height search. It has four children per node. Its leaves are rectangles of the pieces with
// their second-order models, as large as the ball's radius allows.
#pragma once

#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/search_leaf.h"
#include "core/base/run_context.h"
#include "core/surface/box_node.h"

namespace patchmill::internal {

// Everything below a child also lies in a half-space up . p <= top. `up` is a unit vector that does not point
// down, mostly the normal there. On a slope the box reaches far under a ball that rests on it, but the
// half-space does not.
struct SearchNode : BoxNode {
  Float4 up_x, up_y, up_z, top;
};

// Leaves by number, in blocks. They never move, so they are never held twice.
class SearchLeaves {
 public:
  const SearchLeaf& operator[](std::int32_t index) const {
    const auto i = static_cast<std::size_t>(index);
    return blocks_[i / kBlock][i % kBlock];
  }
  void Append(const std::vector<SearchLeaf>& leaves);
  std::size_t size() const {
    return blocks_.empty() ? 0 : (blocks_.size() - 1) * kBlock + blocks_.back().size();
  }

 private:
  static constexpr std::size_t kBlock = 4096;
  std::vector<std::vector<SearchLeaf>> blocks_;
};

struct SearchTree {
  std::vector<SearchNode> nodes;  // nodes[0] is the root
  LeafGrid grid;
  SearchLeaves leaves;

  // Prefetches a node's child that will be visited soon.
  void Prefetch(std::int32_t child) const {
    const char* at = child >= 0 ? reinterpret_cast<const char*>(&nodes[static_cast<std::size_t>(child)])
                                : reinterpret_cast<const char*>(&leaves[~child]);
    __builtin_prefetch(at);
    __builtin_prefetch(at + 64);
    if (child >= 0) __builtin_prefetch(at + 128);
  }
};

// Leaves are large where the distance to a centre that rests there is proven convex ([location T6]). They are
// small where a ball of this radius may rest without that proof. About 3 us per leaf. Parallel,
// deterministic. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<SearchTree> BuildSearchTree(const Surface& surface, double radius, const RunContext& run);

}  // namespace patchmill::internal
