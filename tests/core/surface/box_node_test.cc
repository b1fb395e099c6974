#include "core/surface/box_node.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/surface/box_distance.h"
#include "core/surface/leaf_tree.h"
#include "core/surface/node_walk.h"
#include "core/surface/surface.h"
#include "core/surface/write_nodes.h"
#include "tests/support/clock.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

struct Tree {
  std::vector<Box3> boxes;  // of the leaves
  std::vector<BoxNode> nodes;
};

Tree MakeTree(std::size_t leaves, Random& random) {
  Tree tree;
  for (std::size_t i = 0; i < leaves; ++i) {
    Box3 box;
    box.Add(Vec3(random.Uniform(-50, 50), random.Uniform(-50, 50), random.Uniform(-5, 5)));
    box.Add(Vec3(box.min + Vec3(random.Uniform(0, 2), random.Uniform(0, 2), random.Uniform(0, 2))));
    tree.boxes.push_back(box);
  }
  EXPECT_TRUE(WriteNodes(BuildLeafTree(tree.boxes, RunContext()), RunContext(), tree.nodes).ok());
  return tree;
}

Box3 BoxOf(const BoxNode& node, int k) {
  Box3 box;
  box.min = Vec3(node.min_x[k], node.min_y[k], node.min_z[k]);
  box.max = Vec3(node.max_x[k], node.max_y[k], node.max_z[k]);
  return box;
}

bool Holds(const Box3& outer, const Box3& inner) {
  return (outer.min.array() <= inner.min.array()).all() && (outer.max.array() >= inner.max.array()).all();
}

// Every leaf below a node counts, and lies in the boxes of all that are above it.
void Visit(const Tree& tree, std::int32_t at, const std::vector<Box3>& above, std::vector<int>& seen) {
  const BoxNode& node = tree.nodes[static_cast<std::size_t>(at)];
  for (int k = 0; k < 4; ++k) {
    if (node.IsEmpty(k)) continue;
    std::vector<Box3> all = above;
    all.push_back(BoxOf(node, k));
    if (node.child[k] >= 0) {
      Visit(tree, node.child[k], all, seen);
      continue;
    }
    const auto leaf = static_cast<std::size_t>(~node.child[k]);
    ++seen[leaf];
    for (const Box3& box : all) EXPECT_TRUE(Holds(box, tree.boxes[leaf]));
    EXPECT_LT((all.back().max - tree.boxes[leaf].max).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_LT((all.back().min - tree.boxes[leaf].min).cwiseAbs().maxCoeff(), 1e-5);
  }
}

TEST(BoxNodes, HoldEveryLeafOnce) {
  Random random(3);
  for (const std::size_t leaves : {1, 2, 3, 4, 5, 17, 1000}) {
    SCOPED_TRACE(leaves);
    const Tree tree = MakeTree(leaves, random);
    std::vector<int> seen(leaves, 0);
    Visit(tree, 0, {}, seen);
    EXPECT_EQ(seen, std::vector<int>(leaves, 1));
    EXPECT_LE(tree.nodes.size(), leaves);
  }
}

template <Reach kReach>
void ExpectBounds(const Tree& tree, const Vec3& c) {
  for (const BoxNode& node : tree.nodes) {
    const std::array<double, 4> squared = SquaredDistances<kReach>(node, c);
    for (int k = 0; k < 4; ++k) {
      if (node.IsEmpty(k)) continue;
      EXPECT_EQ(squared[static_cast<std::size_t>(k)], SquaredDistance<kReach>(BoxOf(node, k), c));
    }
  }
}

TEST(BoxNodes, DistancesAreThoseOfTheirBoxes) {
  Random random(4);
  const Tree tree = MakeTree(500, random);
  for (int i = 0; i < 100; ++i) {
    const Vec3 c(random.Uniform(-60, 60), random.Uniform(-60, 60), random.Uniform(-8, 8));
    ExpectBounds<Reach::kPoint>(tree, c);
    ExpectBounds<Reach::kUpwardRay>(tree, c);
  }
}

// When the first leaf below a node was visited, and that nearer children had theirs before.
std::size_t FirstBelow(const Tree& tree, std::int32_t at, const Vec3& c,
                       const std::vector<std::size_t>& when) {
  const BoxNode& node = tree.nodes[static_cast<std::size_t>(at)];
  const std::array<double, 4> squared = SquaredDistances<Reach::kPoint>(node, c);
  std::array<std::size_t, 4> first{};
  std::size_t least = when.size();
  for (int k = 0; k < 4; ++k) {
    if (node.IsEmpty(k)) continue;
    const auto own = static_cast<std::size_t>(k);
    first[own] = node.child[k] >= 0 ? FirstBelow(tree, node.child[k], c, when)
                                    : when[static_cast<std::size_t>(~node.child[k])];
    least = std::min(least, first[own]);
    for (std::size_t j = 0; j < own; ++j) {
      if (node.IsEmpty(static_cast<int>(j)) || squared[j] == squared[own]) continue;
      EXPECT_EQ(squared[j] < squared[own], first[j] < first[own]);
    }
  }
  return least;
}

TEST(BoxNodes, WalksGoToNearerChildrenFirst) {
  Random random(6);
  const Tree tree = MakeTree(400, random);
  for (int i = 0; i < 50; ++i) {
    const Vec3 c(random.Uniform(-60, 60), random.Uniform(-60, 60), random.Uniform(-8, 8));
    std::vector<std::size_t> when(tree.boxes.size(), tree.boxes.size());
    std::size_t visited = 0;
    WalkNearestFirst(
        tree.nodes, [&](const BoxNode& node) { return SquaredDistances<Reach::kPoint>(node, c); },
        [](double) { return false; },
        [&](std::int32_t leaf, double) { return when[static_cast<std::size_t>(leaf)] = visited++, false; });
    EXPECT_EQ(FirstBelow(tree, 0, c, when), 0U);
  }
}

// At once, not after a whole tree.
TEST(BoxNodes, StopWhenCancelled) {
  Random random(7);
  const Tree tree = MakeTree(200'000, random);
  const std::vector<SurfaceNode> binary = BuildLeafTree(tree.boxes, RunContext());
  RunContext cancelled;
  cancelled.Cancel();
  const auto seconds = [&](const RunContext& run, absl::StatusCode code) {
    const double start = testing::ClockSeconds(CLOCK_THREAD_CPUTIME_ID);
    EXPECT_EQ(Collapse(binary, run).status().code(), code);
    return testing::ClockSeconds(CLOCK_THREAD_CPUTIME_ID) - start;
  };
  double stopped = kInfinity;
  for (int i = 0; i < 5; ++i) stopped = std::min(stopped, seconds(cancelled, absl::StatusCode::kCancelled));
  EXPECT_LT(stopped, 0.2 * seconds(RunContext(), absl::StatusCode::kOk));
}

// None left out that may be the nearest, and none at all when nothing is excluded.
TEST(BoxNodes, WalksFindTheNearestLeafWithAndWithoutALimit) {
  Random random(5);
  for (const std::size_t leaves : {1, 3, 400}) {
    const Tree tree = MakeTree(leaves, random);
    for (int i = 0; i < 50; ++i) {
      const Vec3 c(random.Uniform(-60, 60), random.Uniform(-60, 60), random.Uniform(-8, 8));
      double least = kInfinity;
      for (const Box3& box : tree.boxes) least = std::min(least, SquaredDistance<Reach::kPoint>(box, c));
      double nearest = kInfinity;
      std::size_t visited = 0;
      const auto bound = [&](const BoxNode& node) { return SquaredDistances<Reach::kPoint>(node, c); };
      WalkNearestFirst(
          tree.nodes, bound, [&](double squared) { return squared >= nearest; },
          [&](std::int32_t leaf, double max_z) {
            const Box3& box = tree.boxes[static_cast<std::size_t>(leaf)];
            EXPECT_GE(max_z, box.max.z());
            nearest = std::min(nearest, SquaredDistance<Reach::kPoint>(box, c));
            return false;
          });
      EXPECT_EQ(nearest, least);
      WalkNearestFirst(
          tree.nodes, bound, [](double squared) { return squared >= kInfinity; },
          [&](std::int32_t, double) { return ++visited, false; });
      EXPECT_EQ(visited, leaves);
    }
  }
}

}  // namespace
}  // namespace patchmill
