// Masks hold all that is near their points, and little more.
#include "cam/path/zlevel/near_spots_mask.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// mm in plan from a cell to the nearest point, the larger of both ways.
double Away(const XyRect& cell, const std::vector<Vec3>& points) {
  double least = kInfinity;
  for (const Vec3& p : points) {
    const Vec2 off = ((Xy(p) - cell.mid).cwiseAbs() - cell.half).cwiseMax(0.0);
    least = std::min(least, off.maxCoeff());
  }
  return least;
}

TEST(NearSpotsMask, HoldsWhatIsNear) {
  Random random(21);
  int near = 0, far = 0;
  for (int round = 0; round < 100; ++round) {
    std::vector<Vec3> points;
    for (int i = 0; i <= round % 8; ++i)
      points.emplace_back(random.Uniform(-50, 50), random.Uniform(-20, 20), random.Uniform(-9, 9));
    const double reach = random.Uniform(0.3, 6.0);
    const NearSpotsMask mask(points, reach);
    for (int k = 0; k < 200; ++k) {
      const double size = std::pow(10.0, random.Uniform(-2.0, 1.5));
      const XyRect cell{Vec2(random.Uniform(-70, 70), random.Uniform(-40, 40)), Vec2(size, size)};
      const double away = Away(cell, points);
      if (away <= reach) {
        EXPECT_TRUE(mask.Meets(cell));
        ++near;
      }
      if (away > 1.5 * reach * (1.0 + 1e-12)) {
        EXPECT_FALSE(mask.Meets(cell));
        ++far;
      }
    }
  }
  EXPECT_GT(near, 1000);
  EXPECT_GT(far, 1000);
}

TEST(NearSpotsMask, WithoutPointsHoldsNothing) {
  EXPECT_FALSE(NearSpotsMask({}, 1.0).Meets({Vec2::Zero(), Vec2(1e6, 1e6)}));
}

// As many squares as there is room for, however far apart the points lie.
TEST(NearSpotsMask, OfPointsFarApart) {
  const std::vector<Vec3> points = {{-1e5, 0, 0}, {1e5, 3e4, 0}};
  const NearSpotsMask mask(points, 0.01);
  for (const Vec3& p : points) EXPECT_TRUE(mask.Meets({Xy(p), Vec2(0.01, 0.01)}));
  EXPECT_FALSE(mask.Meets({Vec2(0, 1.5e4), Vec2(1, 1)}));
}

}  // namespace
}  // namespace patchmill
