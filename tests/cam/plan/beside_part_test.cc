// The areas beside walls: where they lie, and what they are.
#include "cam/plan/beside_part.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/status.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/profiles.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kBall = 3.0;                      // mm, radius
constexpr double kX = 20.0, kY = 15.0, kZ = 12.0;  // mm, half sides and height of the box

std::vector<BesideStrip> StripsOf(const PatchModel& model, bool outside = false) {
  const Surface surface = PlacedSurface(model);
  auto strips =
      FindBesideStrips(surface, {.radius = kBall, .tolerance = 0.01, .mill_outside = outside}, RunContext());
  PM_CHECK(strips.ok());
  return *std::move(strips);
}

bool Covers(const std::vector<BesideStrip>& strips, const Vec2& q) {
  return std::any_of(strips.begin(), strips.end(),
                     [&](const BesideStrip& s) { return s.area.SignedDistance(q) > 0.0; });
}

TEST(BesideStrips, SurroundABlock) {
  const auto strips = StripsOf(ClosedBlock(kX, kY, kZ));
  for (const BesideStrip& strip : strips) {
    EXPECT_EQ(strip.kind, StripKind::kOutside);
    EXPECT_NEAR(strip.lowest_tip_z, kZ, 0.01);
  }
  for (int k = 0; k < 720; ++k) {  // a ball radius around it, corners rounded
    const double angle = Radians(0.5 * k);
    const Vec2 way(std::cos(angle), std::sin(angle));
    const double side = std::min(kX / std::abs(way.x()), kY / std::abs(way.y()));
    EXPECT_TRUE(Covers(strips, side * way + kBall * way)) << k;
    EXPECT_FALSE(Covers(strips, (side - 0.01) * way)) << k;
  }
  EXPECT_TRUE(StripsOf(ClosedBlock(kX, kY, kZ), true).empty());
}

TEST(BesideStrips, AreMaterialBehindTheWallsOfABox) {
  for (const bool outside : {false, true}) {
    const auto strips = StripsOf(OpenBox(kX, kY, kZ), outside);
    EXPECT_FALSE(strips.empty());
    for (const BesideStrip& strip : strips) EXPECT_EQ(strip.kind, StripKind::kMaterial);
    EXPECT_TRUE(Covers(strips, {kX + kBall, 0}));
    EXPECT_FALSE(Covers(strips, {kX - kBall, 0}));
  }
}

TEST(BesideStrips, AreNoneWhereNothingOutsideIsUpright) {
  EXPECT_TRUE(StripsOf(Block(8, 10, 25)).empty());
  EXPECT_TRUE(StripsOf(Sphere({0, 0, 0}, 12, Half::kUpper)).empty());
  EXPECT_TRUE(StripsOf(TwoHills()).empty());
  EXPECT_TRUE(StripsOf(Wall({0, 0}, {20, 0}, 0, 10)).empty());  // alone: both sides are milled
}

// A plate with a square hole through it: the hole's walls are none of the outside.
TEST(BesideStrips, LeaveHolesAlone) {
  const PatchModel plate =
      Join({Level(-20, -20, 20, -5, 8), Level(-20, 5, 20, 20, 8), Level(-20, -5, -5, 5, 8),
            Level(5, -5, 20, 5, 8), Walls(5, 5, 0, 8), Walls(20, 20, 0, 8)});
  const auto strips = StripsOf(plate);
  EXPECT_TRUE(Covers(strips, {23, 0}));
  EXPECT_FALSE(Covers(strips, {0, 0}));
  EXPECT_FALSE(Covers(strips, {4, 0}));
}

// A closed cylinder, small against the grid that tells its outside: its chords lie inside of it.
TEST(BesideStrips, SurroundSmallCylinders) {
  for (const double radius : {2.0, 5.0, 15.0, 40.0}) {
    SCOPED_TRACE(radius);
    const double high = 6.0;
    const auto strips = StripsOf(Turned(
        {Line({0, high}, {radius, high}), Line({radius, high}, {radius, 0}), Line({radius, 0}, {0, 0})}));
    for (int k = 0; k < 720; ++k) {
      const double angle = Radians(0.5 * k);
      const Vec2 way(std::cos(angle), std::sin(angle));
      EXPECT_TRUE(Covers(strips, (radius + kBall) * way)) << k;
      EXPECT_TRUE(Covers(strips, (radius + 0.3) * way)) << k;
      EXPECT_FALSE(Covers(strips, (radius - 0.01) * way)) << k;
    }
  }
}

// A step in the middle of a wall that is one patch: the wall's other parts are on the outer border.
TEST(BesideStrips, StandBesideAWallThatAStepTouches) {
  const auto strips =
      StripsOf(Join({ClosedBlock(kX, kY, kZ), Level(-5, -25, 5, -kY, 5), Wall({-5, -25}, {5, -25}, 0, 5),
                     Wall({5, -25}, {5, -kY}, 0, 5), Wall({-5, -kY}, {-5, -25}, 0, 5)}));
  for (const double x : {-19.0, -12.0, -8.0, 8.0, 12.0, 19.0})
    EXPECT_TRUE(Covers(strips, {x, -kY - 1.0})) << x;
  EXPECT_FALSE(Covers(strips, {0.0, -kY - 1.0}));
  EXPECT_FALSE(Covers(strips, {0.0, -20.0}));
}

// A thin rib along the border of a large plate: no cell of the grid lies on its top alone.
TEST(BesideStrips, LeaveTheTopOfAThinRibAlone) {
  constexpr double kHalf = 240.0, kWide = 150.0, kPlate = 2.0, kTop = 20.0;
  for (const double thick : {0.6, 1.0, 1.9, 4.0}) {
    const double inner = kWide - thick;
    const auto strips = StripsOf(Join(
        {Level(-kHalf, -kWide, kHalf, kWide, 0), Level(-kHalf, -kWide, kHalf, inner, kPlate),
         Level(-kHalf, inner, kHalf, kWide, kTop), Wall({-kHalf, inner}, {kHalf, inner}, kPlate, kTop),
         Wall({kHalf, kWide}, {-kHalf, kWide}, 0, kTop), Wall({-kHalf, -kWide}, {kHalf, -kWide}, 0, kPlate),
         Wall({-kHalf, -kWide}, {-kHalf, inner}, 0, kPlate), Wall({kHalf, -kWide}, {kHalf, inner}, 0, kPlate),
         Wall({-kHalf, inner}, {-kHalf, kWide}, 0, kTop), Wall({kHalf, inner}, {kHalf, kWide}, 0, kTop)}));
    for (const double x : {-200.0, -31.0, 0.0, 150.0}) {
      EXPECT_FALSE(Covers(strips, {x, kWide - 0.5 * thick})) << thick;
      EXPECT_FALSE(Covers(strips, {x, inner + 0.9 * thick})) << thick;
      EXPECT_TRUE(Covers(strips, {x, kWide + kBall})) << thick;
    }
  }
}

// A channel around a core that the model does not have: behind its inner wall there is material, though it
// is a hole as seen from above.
TEST(BesideStrips, AreMaterialInsideAChannel) {
  for (const bool outside : {false, true}) {
    const auto strips =
        StripsOf(Turned({Line({15, 8}, {15, 0}), Line({15, 0}, {30, 0}), Line({30, 0}, {30, 8})}), outside);
    for (int k = 0; k < 720; ++k) {
      const double angle = Radians(0.5 * k);
      const Vec2 way(std::cos(angle), std::sin(angle));
      for (const double r : {15.0 - kBall, 30.0 + kBall})
        EXPECT_TRUE(Covers(strips, r * way)) << r << " " << k;
      for (const double r : {15.0 + kBall, 30.0 - kBall})
        EXPECT_FALSE(Covers(strips, r * way)) << r << " " << k;
    }
  }
}

}  // namespace
}  // namespace patchmill
