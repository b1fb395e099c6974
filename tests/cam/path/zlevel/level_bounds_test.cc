// Bounds on centres: no ball that touches the surface from above or from beside may lie outside of them.
#include "cam/path/zlevel/level_bounds.h"

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "tests/cam/path/zlevel/level_checks.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::MakeSurface;

constexpr double kR = 3.0;

bool Inside(const LevelBounds::NodeBox& box, const Vec3& c) {
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (c[k] < box.min[i] || c[k] > box.max[i]) return false;
  }
  return true;
}

struct Count {
  int centers = 0, free = 0, directed = 0;
};

// Balls on a grid of points of every leaf, on both sides.
Count CheckSurface(const Surface& surface) {
  const Locator locator(surface, kR);
  const RunContext run(1);
  const PieceSides sides(surface, run);
  const LevelBounds bounds(surface, sides, kR, run);
  Count count;
  for (std::size_t n = 0; n < surface.nodes.size(); ++n) {
    const SurfaceNode& node = surface.nodes[n];
    if (node.leaf < 0) continue;
    const auto index = static_cast<std::size_t>(node.leaf);
    const SurfaceLeaf& leaf = surface.leaves[index];
    const NormalCone normals = bounds.Normals(index);
    const LevelBounds::NodeBox& box = bounds.nodes()[n];
    for (int k = 0; k < 9; ++k) {
      const double u = leaf.u0 + (leaf.u1 - leaf.u0) * (k / 3) / 2.0;
      const double v = leaf.v0 + (leaf.v1 - leaf.v0) * (k % 3) / 2.0;
      const SurfaceJet jet = Evaluate(surface, leaf.piece, u, v);
      const auto normal = UnitNormal(jet);
      if (!normal) continue;
      for (const double sign : {1.0, -1.0}) {
        const Vec3 e = sign * *normal;
        if (e.z() < 0.0) continue;
        const Vec3 c = jet.p + kR * e;
        ++count.centers;
        if (normals.angle < kWidestNormals) {
          const int side = e.dot(normals.axis) > 0.0 ? 1 : -1;
          const CenterBounds part = BoundCenters(leaf.Bounds(node.box), normals, side, kR);
          EXPECT_TRUE(part.possible);
          for (int a = 0; a < 3; ++a) {
            EXPECT_LE(std::abs((c - part.center).dot(part.axis.col(a))), part.half[a] + 1e-9);
            EXPECT_GE(c[a], part.box.min[a] - 1e-9);
            EXPECT_LE(c[a], part.box.max[a] + 1e-9);
          }
          if (part.directed) {
            ++count.directed;
            EXPECT_GE(Cross(part.right, Xy(e)), -1e-9);
            EXPECT_LE(Cross(part.left, Xy(e)), 1e-9);
          }
        }
        EXPECT_TRUE(Inside(box, c)) << c.transpose();
        count.free += locator.Free(c, 1e-9);
      }
    }
  }
  // A node holds its children.
  for (std::size_t n = 0; n < surface.nodes.size(); ++n) {
    if (surface.nodes[n].leaf >= 0) continue;
    for (const std::size_t child : {n + 1, static_cast<std::size_t>(surface.nodes[n].right)}) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE(bounds.nodes()[n].min[k], bounds.nodes()[child].min[k]);
        EXPECT_GE(bounds.nodes()[n].max[k], bounds.nodes()[child].max[k]);
      }
    }
  }
  return count;
}

TEST(ContourBounds, HoldEveryBallOnASphere) {
  const Count count = CheckSurface(MakeSurface(testing::Sphere(Vec3::Zero(), 10.0)));
  EXPECT_GT(count.free, 1000);
  EXPECT_GT(count.directed, 1000);
}

TEST(ContourBounds, HoldEveryBallOnWalls) {
  const Count count = CheckSurface(MakeSurface(testing::Block(8.0, 5.0, 20.0)));
  EXPECT_GT(count.free, 20);
}

TEST(ContourBounds, HoldEveryBallOnRandomSplines) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Count count =
        CheckSurface(MakeSurface(testing::RandomBspline(seed, {.folds = seed > 1, .rational = seed == 3})));
    EXPECT_GT(count.free, 500);
  }
}

}  // namespace
}  // namespace patchmill
