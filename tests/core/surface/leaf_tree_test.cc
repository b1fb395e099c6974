#include "core/surface/leaf_tree.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"

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

TEST(LeafTree, HoldsEveryBoxOnceAndIsTheSameForAnyNumberOfThreads) {
  testing::Random random(3);
  std::vector<Box3> boxes;
  for (int i = 0; i < 5000; ++i) boxes.push_back(Cube(random.Point(-10, 10), random.Uniform(0.0, 1.0)));
  const auto nodes = BuildLeafTree(boxes, RunContext(1));
  const auto parallel = BuildLeafTree(boxes, RunContext(4));
  ASSERT_EQ(nodes.size(), 9999u);
  ASSERT_EQ(parallel.size(), nodes.size());
  std::vector<int> held(boxes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_EQ(nodes[i].right, parallel[i].right);
    EXPECT_EQ(nodes[i].leaf, parallel[i].leaf);
    EXPECT_EQ(nodes[i].box.min, parallel[i].box.min);
    EXPECT_EQ(nodes[i].box.max, parallel[i].box.max);
    if (nodes[i].leaf >= 0) {
      ++held[static_cast<std::size_t>(nodes[i].leaf)];
      continue;
    }
    Box3 both = nodes[i + 1].box;
    both.Add(nodes[static_cast<std::size_t>(nodes[i].right)].box);
    EXPECT_EQ(both.min, nodes[i].box.min);
    EXPECT_EQ(both.max, nodes[i].box.max);
  }
  EXPECT_EQ(std::count(held.begin(), held.end(), 1), 5000);
  EXPECT_LE(Depth(nodes, 0), 20);
}

TEST(LeafTree, NothingInNothingOut) { EXPECT_TRUE(BuildLeafTree({}, RunContext(1)).empty()); }

}  // namespace
}  // namespace patchmill
