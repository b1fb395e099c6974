#include "core/surface/box_distance.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

// By golden section over s of the distance of the box to c + s e_z, which is convex in s.
double ByGoldenSection(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half, const Vec3& c) {
  const double ratio = 0.6180339887498949;
  double low = 0.0, high = 200.0;
  const auto f = [&](double s) { return SquaredDistanceToPoint(center, axis, half, c + Vec3(0, 0, s)); };
  while (high - low > 1e-9) {
    const double a = high - ratio * (high - low), b = low + ratio * (high - low);
    (f(a) <= f(b) ? high : low) = f(a) <= f(b) ? b : a;
  }
  return std::min(f(low), f(0.0));
}

TEST(BoxDistance, OrientedBoxesAgreeWithSearches) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 about = random.Point(-1, 1);
    const Eigen::Matrix3d axis =
        i % 7 == 0 ? Eigen::Matrix3d::Identity()
                   : Eigen::AngleAxisd(random.Uniform(0, 3), about.normalized()).toRotationMatrix();
    const Vec3 center = random.Point(-10, 10), c = random.Point(-20, 20);
    Vec3 half = random.Point(0, 8);
    if (i % 3 == 0) half.z() = 0.0;
    // The point: nearest of the box by clamping in its own frame.
    const Vec3 local = axis.transpose() * (c - center);
    const Vec3 nearest = local.cwiseMax(-half).cwiseMin(half);
    EXPECT_NEAR(SquaredDistanceToPoint(center, axis, half, c), (local - nearest).squaredNorm(), 1e-9);
    EXPECT_NEAR(SquaredDistanceToUpwardRay(center, axis, half, c), ByGoldenSection(center, axis, half, c),
                1e-7);
  }
}

TEST(BoxDistance, AxisParallelBoxesAreOrientedOnes) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 center = random.Point(-10, 10), half = random.Point(0, 8), c = random.Point(-20, 20);
    const Box3 box{center - half, center + half};
    const Eigen::Matrix3d axis = Eigen::Matrix3d::Identity();
    EXPECT_NEAR(SquaredDistance<Reach::kPoint>(box, c), SquaredDistanceToPoint(center, axis, half, c), 1e-9);
    EXPECT_NEAR(SquaredDistance<Reach::kUpwardRay>(box, c), SquaredDistanceToUpwardRay(center, axis, half, c),
                1e-9);
  }
}

}  // namespace
}  // namespace patchmill
