#include "core/surface/leaf_tree.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

int Depth(const std::vector<SurfaceNode>& nodes, std::size_t index) {
  if (nodes[index].leaf >= 0) return 1;
  return 1 + std::max(Depth(nodes, index + 1), Depth(nodes, static_cast<std::size_t>(nodes[index].right)));
}

Box3 Cube(const Vec3& center, double half) {
  return {center - Vec3::Constant(half), center + Vec3::Constant(half)};
}

TEST(LeafTree, EqualBoxesAreHalved) {
  const std::vector<Box3> boxes(1000, Cube(Vec3(1, 2, 3), 1.0));
  const auto nodes = BuildLeafTree(boxes, RunContext(1));
  EXPECT_EQ(nodes.size(), 1999u);
  EXPECT_EQ(Depth(nodes, 0), 11);  // 2^10 >= 1000
}

TEST(LeafTree, BoxesThatShrinkGeometricallyStayShallow) {
  // Each cut of the plain heuristic would take off one box.
  std::vector<Box3> boxes;
  for (int i = 0; i < 2000; ++i) boxes.push_back(Cube(Vec3(std::pow(0.7, i), 0, 0), 0.1 * std::pow(0.7, i)));
  const auto nodes = BuildLeafTree(boxes, RunContext(1));
  EXPECT_EQ(nodes.size(), 3999u);
  EXPECT_LE(Depth(nodes, 0), 30 + 12);
}

TEST(LeafTree, PartsClustersFirst) {
  std::vector<Box3> boxes;
  for (int i = 0; i < 8; ++i) boxes.push_back(Cube(Vec3(i % 2 == 0 ? 0.0 : 100.0, 0.1 * i, 0), 0.5));
  const auto nodes = BuildLeafTree(boxes, RunContext(1));
  EXPECT_LT(nodes[1].box.max.x(), 1.0);
  EXPECT_GT(nodes[static_cast<std::size_t>(nodes[0].right)].box.min.x(), 99.0);
}

TEST(LeafTree, NothingInNothingOut) { EXPECT_TRUE(BuildLeafTree({}, RunContext(1)).empty()); }

}  // namespace
}  // namespace patchmill
