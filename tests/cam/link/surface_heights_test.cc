#include "cam/link/surface_heights.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;

// The bound is never below the surface over the rectangle, and not above the surface within two squares of
// it.
TEST(SurfaceHeights, BoundTheSurfaceOverRectangles) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Surface surface = testing::SurfaceOf(testing::RandomBspline(seed));
    const double beside = 2.0;
    const SurfaceHeights heights(surface, beside);
    std::vector<Vec3> points;
    Random random(seed);
    for (int i = 0; i < 20000; ++i) {
      const auto piece = static_cast<std::size_t>(random.Uniform(0, 0.999999) * surface.pieces.size());
      points.push_back(Position(surface.pieces[piece], random.Uniform(0, 1), random.Uniform(0, 1)));
    }
    const Vec2 size = Xy(surface.box.max - surface.box.min);
    const double square = (size.maxCoeff() + 2.0 * beside) / 64.0;
    double leaf = 0.0;  // a leaf counts as a whole
    for (const SurfaceNode& node : surface.nodes) {
      if (node.leaf >= 0) leaf = std::max(leaf, Xy(node.box.max - node.box.min).maxCoeff());
    }
    for (int k = 0; k < 200; ++k) {
      const Vec2 a(random.Uniform(-5, 45), random.Uniform(-5, 45)),
          b(random.Uniform(-5, 45), random.Uniform(-5, 45));
      const Vec2 low = a.cwiseMin(b), high = a.cwiseMax(b);
      const auto highest = [&](double margin) {
        double z = -kInfinity;
        for (const Vec3& p : points) {
          if ((Xy(p) - Xy(p).cwiseMax(low).cwiseMin(high)).cwiseAbs().maxCoeff() <= margin)
            z = std::max(z, p.z());
        }
        return z;
      };
      const double got = heights.HighestOver(a, b);
      // Points outside of the grid count for its outermost squares.
      if ((high.array() < surface.box.min.head<2>().array() - beside).any() ||
          (low.array() > surface.box.max.head<2>().array() + beside).any()) {
        continue;
      }
      EXPECT_GE(got, highest(beside));
      EXPECT_LE(got, highest(beside + 2.0 * square + 2.0 * leaf) + 0.5);  // 0.5: error of samples and boxes
    }
  }
}

TEST(SurfaceHeights, NothingStandsBesideThePart) {
  const Surface surface = testing::SurfaceOf(testing::Join(
      {testing::Plane(5),
       testing::Transformed(testing::Plane(5, 2), Eigen::Affine3d(Eigen::Translation3d(90, 0, 0)))}));
  const SurfaceHeights heights(surface, 1.0);
  EXPECT_EQ(heights.HighestOver({30, -1}, {60, 1}), -kInfinity);
  EXPECT_EQ(heights.HighestOver({-2, -1}, {2, 1}), 0.0);
  EXPECT_EQ(heights.HighestOver({-2, -1}, {90, 1}), 2.0);
}

}  // namespace
}  // namespace patchmill
