// Balls that nearly fit: the nearest free centre against closed forms, and random folded parts.
#include "cam/location/free_center.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "tests/support/profiles.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kRadius = 3.0;

// z = |x| tan(angle): a ball that touches the right plane at a distance x along it is `deep` in the left one.
TEST(FreeCenterNear, GivesWaySidewaysInACrease) {
  for (const double degrees : {20.0, 45.0, 70.0}) {
    const double angle = Radians(degrees), deep = 0.03;
    const Surface surface = SurfaceOf(TwoPlanes(angle, 20.0));
    const Locator locator(surface, kRadius);
    const Vec3 right(-std::sin(angle), 0, std::cos(angle)), left(std::sin(angle), 0, std::cos(angle));
    const Vec3 up_right(std::cos(angle), 0, std::sin(angle));
    // left . (t up_right + R right) = R - deep
    const double t = (kRadius - deep - kRadius * left.dot(right)) / left.dot(up_right);
    const Vec3 p = t * up_right;
    EXPECT_FALSE(locator.Free(p + kRadius * right));
    const auto c = FreeCenterNear(locator, p, right, {.most = kRadius});
    ASSERT_TRUE(c.has_value()) << degrees;
    EXPECT_TRUE(locator.Free(*c));
    // The point of both half-spaces that is nearest to p: beside p's own centre on its plane, or on both.
    const double sideways = deep / left.dot(up_right);
    EXPECT_NEAR((*c - p).norm(), std::hypot(kRadius, sideways), 1e-5) << degrees;
  }
}

TEST(FreeCenterNear, KeepsAboveTheFloorAndGivesUpWhereItLeavesTooMuch) {
  const Surface surface = SurfaceOf(Plane(20.0));
  const Locator locator(surface, kRadius);
  const auto over =
      FreeCenterNear(locator, Vec3::Zero(), Vec3::UnitZ(), {.lowest_z = kRadius + 0.5, .most = 1.0});
  ASSERT_TRUE(over.has_value());
  EXPECT_NEAR(over->z(), kRadius + 0.5, 1e-6);
  EXPECT_FALSE(FreeCenterNear(locator, Vec3::Zero(), Vec3::UnitZ(), {.lowest_z = kRadius + 0.5, .most = 0.4})
                   .has_value());
}

// Between two walls as far apart as the ball is wide nothing is free but for rounding; a little gouge finds
// the middle.
TEST(FreeCenterNear, BetweenWallsThatLeaveNoRoom) {
  constexpr double kGouge = 5e-4;
  for (const double less : {0.0, 3e-4, 2e-3}) {  // of room
    const double width = 2.0 * kRadius - less;
    const Surface surface = SurfaceOf(Drawn({Line({0, 0}, {0, 10}), Line({width, 0}, {width, 10})}, 20.0));
    const Locator locator(surface, kRadius);
    const Vec3 p(0, 8, 5);
    EXPECT_FALSE(FreeCenterNear(locator, p, Vec3::UnitX(), {.most = 0.5}));
    const auto c = FreeCenterNear(locator, p, Vec3::UnitX(), {.most = 0.5, .gouge = kGouge});
    EXPECT_EQ(c.has_value(), less < 2.0 * kGouge) << less;
    if (!c) continue;
    EXPECT_GE(std::min(c->x(), width - c->x()), kRadius - kGouge);
    EXPECT_LE((*c - p).norm(), kRadius + 1e-5);
  }
}

// Wherever a ball smaller by a tolerance is free, the whole one leaves no more than along the normal.
TEST(FreeCenterNear, LeavesNoMoreThanAlongTheNormal) {
  const double tolerance = 0.03;
  int pushed = 0, sideways = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const Surface surface = SurfaceOf(RandomBspline(seed, {.spans = 3, .size = 12.0, .folds = true}));
    const Locator whole(surface, 1.8), smaller(surface, 1.8 - tolerance);
    Random random(seed);
    for (int k = 0; k < 4000; ++k) {
      const PieceId piece(static_cast<std::size_t>(random.Int(static_cast<int>(surface.pieces.size()))));
      const SurfaceJet jet = Evaluate(surface, piece, random.Uniform(0, 1), random.Uniform(0, 1));
      const auto n = UpwardNormal(jet);
      const Vec3 center = n ? Vec3(jet.p + 1.8 * *n) : jet.p;
      if (!n || !smaller.Free(center) || whole.Free(center)) continue;
      ++pushed;
      double along = 1e-7;
      while (along < 0.2 && !whole.Free(center + along * *n)) along += 0.002;
      const auto c = FreeCenterNear(whole, jet.p, *n, {.most = 0.2});
      if (along >= 0.2) continue;
      ASSERT_TRUE(c.has_value());
      EXPECT_TRUE(whole.Free(*c));
      // Bent obstacles are taken for the planes that touch them.
      EXPECT_LE((*c - jet.p).norm() - 1.8, 1.1 * along + 1e-4);
      sideways += (*c - jet.p).norm() - 1.8 < 0.5 * along;
    }
  }
  EXPECT_GT(pushed, 20);
  EXPECT_GT(sideways, pushed / 20);
}

}  // namespace
}  // namespace patchmill
