#include "cam/location/half_spaces.h"

#include <gtest/gtest.h>

#include "core/network/patch_model.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill::internal {
namespace {

// Of all leaves below a node's child the corners of their boxes.
void VisitCorners(const SearchTree& tree, std::int32_t child, const auto& visit) {
  if (child >= 0) {
    const SearchNode& node = tree.nodes[static_cast<std::size_t>(child)];
    for (int k = 0; k < 4; ++k) {
      if (!node.IsEmpty(k)) VisitCorners(tree, node.child[k], visit);
    }
    return;
  }
  const LeafBox box = tree.leaves[~child].Box(tree.grid);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 side(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0);
    visit(Vec3(box.center + box.axis * side.cwiseProduct(box.half)));
  }
}

TEST(HalfSpaces, HoldAllLeavesBelow) {
  for (const double away : {0.0, 1e5}) {  // mm
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      Placement placement;
      placement.translation = Vec3(away, -away, 0.5 * away);
      const Surface surface = testing::SurfaceOf(Place(placement, testing::RandomBspline(seed)));
      const auto tree = BuildSearchTree(surface, 3.0, RunContext());
      ASSERT_TRUE(tree.ok()) << tree.status();
      int tight = 0, bounded = 0;
      for (const SearchNode& node : tree->nodes) {
        for (int k = 0; k < 4; ++k) {
          if (node.IsEmpty(k)) continue;
          const Vec3 up(node.up_x[k], node.up_y[k], node.up_z[k]);
          EXPECT_NEAR(up.norm(), 1.0, 1e-6);
          EXPECT_GE(up.z(), 0.0);
          double most = -kInfinity;
          VisitCorners(*tree, node.child[k], [&](const Vec3& p) { most = std::max(most, up.dot(p)); });
          const double top = static_cast<double>(node.top[k]);
          EXPECT_LE(most, top + 1e-9);
          if (up == Vec3::UnitZ()) continue;
          ++bounded;
          tight += top - most < 3e-7 * (200.0 + 3.0 * away);  // what rounding to floats costs
        }
      }
      EXPECT_GT(bounded, 20);
      EXPECT_EQ(tight, bounded);
    }
  }
}

}  // namespace
}  // namespace patchmill::internal
