// Where a wide shank is clear of a block on a plate, in closed form.
#include "cam/location/limits/shank_limit.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kHalf = 10.0, kTop = 30.0;                   // the block
constexpr double kRadius = 5.0, kRise = 12.0, kProof = 1e-3;  // the shank

// How deep the block and the plate under it stand in the shank over c; below 0 how far they are from it.
double Depth(const Vec3& c, double keep) {
  const double radius = kRadius + keep, bottom = c.z() + kRise - keep;
  const double beside = (Xy(c).cwiseAbs().array() - kHalf).max(0.0).matrix().norm();
  const double block = std::min(radius - beside, kTop - bottom);
  return std::max(block, std::min(radius, 0.0 - bottom));
}

class ShankOverABlock : public ::testing::TestWithParam<double> {
 protected:
  const Surface surface_ = SurfaceOf(Block(kHalf, kTop, 40));
  const double keep_ = GetParam();
  const ShankLimit limit_{surface_, UpperCylinder{kRadius, kRise}, keep_, kProof, kProof};
};

TEST_P(ShankOverABlock, CentresMovesAndBalls) {
  Random random(5);
  int clear = 0, hit = 0, forbidden = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 c(random.Uniform(-20, 20), random.Uniform(-20, 20), random.Uniform(-20, 25));
    const double allowed_penetration = random.Uniform(0.0, 0.5), depth = Depth(c, keep_);
    if (std::abs(depth - allowed_penetration) > 2.0 * kProof) {
      EXPECT_EQ(limit_.Clears(c, c, allowed_penetration), depth < allowed_penetration) << c.transpose();
    }
    const double around = random.Uniform(0.0, 4.0);
    if (std::abs(depth - around) > 2.0 * kProof) {
      EXPECT_EQ(limit_.Forbids(c, around, around), depth > around) << c.transpose();
    }
    forbidden += depth > around;
    // Higher and to the side by different lengths.
    const double above = random.Uniform(0.0, 4.0);
    if (limit_.Forbids(c, around, above)) {
      const double turn = random.Uniform(0.0, 2.0 * kPi), out = random.Unit() * around;
      const Vec3 to = c + Vec3(out * std::cos(turn), out * std::sin(turn), random.Unit() * above);
      EXPECT_GT(Depth(to, keep_), -2.0 * kProof) << c.transpose();
    }
    // A move, by places along it.
    const Vec3 to = c + random.Uniform(0.0, 6.0) *
                            Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
    double deepest = -kInfinity;
    constexpr int kPlaces = 400;
    for (int k = 0; k <= kPlaces; ++k) {
      deepest = std::max(deepest, Depth(c + (to - c) * (static_cast<double>(k) / kPlaces), keep_));
    }
    const double between = (to - c).norm() / kPlaces;
    if (deepest > allowed_penetration + 2.0 * kProof) {
      EXPECT_FALSE(limit_.Clears(c, to, allowed_penetration)) << c.transpose() << " to " << to.transpose();
      ++hit;
    }
    if (deepest < allowed_penetration - between - 2.0 * kProof) {
      EXPECT_TRUE(limit_.Clears(c, to, allowed_penetration)) << c.transpose() << " to " << to.transpose();
      ++clear;
    }
  }
  EXPECT_GT(clear, 500);
  EXPECT_GT(hit, 500);
  EXPECT_GT(forbidden, 300);
}

TEST_P(ShankOverABlock, LowestCentre) {
  const double low = -kRise + keep_, high = kTop - kRise + keep_, reach = kHalf + kRadius + keep_;
  for (const double x : {reach - 0.01, reach + 0.01}) {
    const double truth = x < reach ? high : low;
    EXPECT_NEAR(limit_.LowestOver(Vec2(x, 3), 0.0, -kInfinity, kProof), truth, kProof);
    EXPECT_NEAR(limit_.LowestOver(Vec2(x, 3), 0.0, truth - 1.0, kProof), truth, kProof);
    EXPECT_EQ(limit_.LowestOver(Vec2(x, 3), 0.0, truth + kProof, kProof), -kInfinity);
  }
  EXPECT_NEAR(limit_.LowestOver(Vec2(0, 0), 0.3, -kInfinity, kProof), high - 0.3, kProof);
  EXPECT_EQ(limit_.LowestOver(Vec2(100, 0), 0.0, -kInfinity, kProof), -kInfinity);
}

INSTANTIATE_TEST_SUITE_P(All, ShankOverABlock, ::testing::Values(0.0, 0.4));

}  // namespace
}  // namespace patchmill
