#include "cam/location/half_spaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/base/parallel.h"

namespace patchmill::internal {
namespace {

// Parts of a surface with more leaves than this bend too much.
constexpr std::int32_t kMostLeaves = 2048;

// The leaves below every node, one after the other. For each child: the range of its leaves.
struct LeafOrder {
  std::vector<std::int32_t> leaves;
  std::vector<std::array<std::pair<std::int32_t, std::int32_t>, 4>> of_child;
};

void Order(const SearchTree& tree, std::int32_t at, LeafOrder& order) {
  const SearchNode& node = tree.nodes[static_cast<std::size_t>(at)];
  for (int k = 0; k < 4; ++k) {
    const auto first = static_cast<std::int32_t>(order.leaves.size());
    if (!node.IsEmpty(k)) {
      if (node.child[k] >= 0) {
        Order(tree, node.child[k], order);
      } else {
        order.leaves.push_back(~node.child[k]);
      }
    }
    order.of_child[static_cast<std::size_t>(at)][static_cast<std::size_t>(k)] = {
        first, static_cast<std::int32_t>(order.leaves.size())};
  }
}

// The normal of a box, on the side that does not point down. For vertical boxes the choice is always the
// same.
Vec3 NormalOf(const LeafBox& box) {
  const Vec3 n = box.axis.col(2);
  const double side = n.z() != 0.0 ? n.z() : n.x() != 0.0 ? n.x() : n.y();
  return side < 0.0 ? Vec3(-n) : n;
}

void BoundChild(const SearchTree& tree, std::span<const std::int32_t> leaves, int k, SearchNode& node) {
  Vec3 up = Vec3::UnitZ();
  if (static_cast<std::int32_t>(leaves.size()) <= kMostLeaves) {
    Vec3 sum = Vec3::Zero();
    for (const std::int32_t leaf : leaves) {
      const LeafBox box = tree.leaves[leaf].Box(tree.grid);
      sum += (box.half.x() * box.half.y()) * NormalOf(box);
    }
    if (const double length = sum.norm(); length > 0.0) up = sum / length;
  }
  node.up_x[k] = static_cast<float>(up.x());
  node.up_y[k] = static_cast<float>(up.y());
  node.up_z[k] = std::max(0.0F, static_cast<float>(up.z()));
  const Vec3 stored(node.up_x[k], node.up_y[k], node.up_z[k]);
  node.top[k] = node.max_z[k];
  if (up == Vec3::UnitZ()) return;
  double top = -kInfinity;
  for (const std::int32_t leaf : leaves) {
    const LeafBox box = tree.leaves[leaf].Box(tree.grid);
    top = std::max(top, stored.dot(box.center) + (box.axis.transpose() * stored).cwiseAbs().dot(box.half));
  }
  node.top[k] = RoundUp(top);
}

}  // namespace

absl::Status BoundByHalfSpaces(const RunContext& run, SearchTree& tree) {
  LeafOrder order;
  order.of_child.resize(tree.nodes.size());
  Order(tree, 0, order);
  return ParallelFor(run, nullptr, tree.nodes.size(), [&](std::size_t i) {
    for (int k = 0; k < 4; ++k) {
      const auto [first, last] = order.of_child[i][static_cast<std::size_t>(k)];
      const std::span<const std::int32_t> leaves(order.leaves.data() + first, order.leaves.data() + last);
      BoundChild(tree, leaves, k, tree.nodes[i]);
    }
  });
}

}  // namespace patchmill::internal
