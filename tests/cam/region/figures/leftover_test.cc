// Leftover of unreachable places, against closed forms. It is the distance to the nearest free centre, which
// need not be above the place.
#include "cam/region/figures/leftover.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/deepest_leftover.h"
#include "tests/support/profiles.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kR = 3.0, kNear = 0.01 * kR;

double LeftoverAt(const Surface& surface, const Vec3& p, const LeftoverParams& params = {}) {
  return DeepestLeftover(Locator(surface, kR), params, {&p, 1}, RunContext()).leftover;
}

absl::StatusOr<OperationLimits> Within(const Surface& surface, const Containment& containment) {
  return OperationLimits::Make(surface, containment, {.ball_radius = kR, .tool_radius = kR}, RunContext());
}

TEST(Leftover, InAValleyOfTwoPlanes) {
  // The ball's centres are a valley of the same slope, R / cos(a) higher. From a place that none of its
  // sides sees at a right angle its bottom is nearest.
  for (const double degrees : {20.0, 45.0, 75.0}) {
    const double a = Radians(degrees);
    const Surface surface = SurfaceOf(TwoPlanes(a, 20));
    const double bottom = kR / std::cos(a), touched = kR * std::sin(a);
    for (const double share : {0.0, 0.1, 0.5, 0.9}) {
      const double x = share * touched;
      const Vec3 p(x, 0.7, x * std::tan(a));
      const double expected = std::hypot(x, bottom - p.z()) - kR;
      EXPECT_NEAR(LeftoverAt(surface, p), expected, kNear) << degrees << " " << share;
    }
    const double beyond = 1.5 * touched;
    EXPECT_NEAR(LeftoverAt(surface, Vec3(beyond, 0, beyond * std::tan(a))), 0.0, kNear) << degrees;
  }
}

// Held all around by the rim of a hole or of a dimple: the free centres end in a tip, above its middle.
TEST(Leftover, UnderARoundRim) {
  for (const double hole : {2.5, 2.9, 2.99}) {
    const double tip = std::sqrt(kR * kR - hole * hole);
    const Surface through = SurfaceOf(Turned({Line({hole, -10}, {hole, 0}), Line({hole, 0}, {12, 0})}));
    for (const double z : {-10.0, -6.3, -1.1}) {
      for (const double turn : {0.1, 2.0, 4.4}) {
        const Vec3 p(hole * std::cos(turn), hole * std::sin(turn), z);
        EXPECT_NEAR(LeftoverAt(through, p), std::hypot(hole, tip - z) - kR, kNear) << hole << " " << z;
      }
    }
    const double rim = Radians(70.0), r = hole;
    const Vec2 edge(r * std::sin(rim), -r * std::cos(rim));
    const Surface dimple =
        SurfaceOf(Turned({{{{0, -r}, {r * std::tan(0.5 * rim), -r}, edge}, {1.0, std::cos(0.5 * rim), 1.0}},
                          Line(edge, {12, edge.y()})}));
    const double over = edge.y() + std::sqrt(kR * kR - edge.x() * edge.x());
    for (const double down : {5.0, 30.0, 60.0}) {
      const Vec3 p(r * std::sin(Radians(down)), 0.0, -r * std::cos(Radians(down)));
      EXPECT_NEAR(LeftoverAt(dimple, p), std::hypot(p.x(), over - p.z()) - kR, kNear) << hole << " " << down;
    }
  }
}

TEST(Leftover, InAValleyThatRunsAslant) {
  // The same, with a bottom along no axis: what stops a search along x and y.
  const double a = Radians(70);
  Eigen::Affine3d turn = Eigen::Affine3d::Identity();
  turn.rotate(Eigen::AngleAxisd(Radians(33), Vec3::UnitZ()));
  const Surface surface = SurfaceOf(Transformed(TwoPlanes(a, 20), turn));
  const double bottom = kR / std::cos(a);
  for (const double x : {0.0, 0.4, 1.5}) {
    const Vec3 p = turn * Vec3(x, 2.0, x * std::tan(a));
    EXPECT_NEAR(LeftoverAt(surface, p), std::hypot(x, bottom - p.z()) - kR, kNear) << x;
  }
}

TEST(Leftover, InASteepGroove) {
  // z = a x^2: offset curves touch both sides from below x_t on and meet at (0, a R^2 + 1 / (4 a)).
  for (const double a : {0.25, 0.5, 1.0}) {
    const Surface surface = SurfaceOf(ParabolicValley(a, 12));
    const Locator locator(surface, kR);
    const double meet = a * kR * kR + 0.25 / a, touch = std::sqrt(kR * kR - 0.25 / (a * a));
    for (const double share : {0.0, 0.3, 0.7, 0.95}) {
      const double x = share * touch;
      const Vec3 p(x, -1.0, a * x * x);
      double nearest = std::hypot(x, meet - p.z());
      for (int i = 0; i <= 4000; ++i) {
        const double t = touch + (12.0 - touch) * i / 4000.0, s = std::hypot(1.0, 2.0 * a * t);
        nearest = std::min(nearest, std::hypot(t - 2.0 * a * t * kR / s - x, a * t * t + kR / s - p.z()));
      }
      EXPECT_NEAR(DeepestLeftover(locator, {}, {&p, 1}, RunContext()).leftover, nearest - kR, kNear)
          << a << " " << share;
    }
  }
}

// A mushroom: a cap on a stem. At the stem's foot, right beside the cap is nearest, wherever the columns
// that are looked at lie.
TEST(Leftover, BesideACap) {
  for (const double cap : {8.0, 9.3, 11.0, 12.0}) {
    for (const double under : {4.0, 10.0}) {
      const std::vector<Vec2> corners = {{0, under + 2}, {cap, under + 2}, {cap, under},
                                         {4, under},     {4, 0},           {30, 0}};
      std::vector<Profile> profiles;
      for (std::size_t i = 0; i + 1 < corners.size(); ++i)
        profiles.push_back(Line(corners[i], corners[i + 1]));
      const Surface surface = SurfaceOf(Turned(profiles));
      for (const double angle : {0.0, 0.3, 0.7}) {
        const Vec3 foot(4.0 * std::cos(angle), 4.0 * std::sin(angle), 0.0);
        const double beside = std::hypot(cap + kR - 4.0, kR) - kR;
        const double over = under + 2.0;
        EXPECT_NEAR(LeftoverAt(surface, foot), std::min(beside, over), 0.02 * (beside + kR))
            << cap << " " << under << " " << angle;
      }
    }
  }
}

TEST(Leftover, UnderASlabIsMeasuredFromItsSide) {
  // Ball and shank keep R from its edge x = 0.
  const double height = 20;
  const Surface surface = SurfaceOf(Join({Plane(60), Single(Bilinear({-30, -30, height}, {0, -30, height},
                                                                     {-30, 30, height}, {0, 30, height}))}));
  for (const double x : {-2.0, -5.0, -9.0})
    EXPECT_NEAR(LeftoverAt(surface, Vec3(x, 0, 0)), std::hypot(x - kR, kR) - kR, kNear) << x;
  // From further in the way over the slab is shorter than the way around.
  const double over = height + kR - kR;
  EXPECT_NEAR(LeftoverAt(surface, Vec3(-28.0, 0, 0)), std::min(over, std::hypot(5.0, kR) - kR), kNear);
}

TEST(Leftover, OverALowFloorIsNone) {
  // Beside an upright wall the ball stands anywhere; a floor keeps it up.
  const Surface surface = SurfaceOf(Sphere(Vec3::Zero(), 10, Half::kUpper));
  const Vec3 rim(10, 0, 0);
  EXPECT_NEAR(LeftoverAt(surface, rim), 0.0, kNear);
  EXPECT_NEAR(LeftoverAt(surface, rim, {.floor_z = 0.0}), std::hypot(std::sqrt(160.0) - 10.0, kR) - kR,
              kNear);
}

TEST(Leftover, KeepsToWhatIsAllowed) {
  // Centres inside x <= 4: of a place beyond, the nearest is that border's.
  const Surface surface = SurfaceOf(Plane(30));
  Containment containment;
  const Outline outline({{{-20, -20}, {4, -20}, {4, 20}, {-20, 20}}});
  containment.boundary = Boundary{outline, BoundaryMode::kCenter, 0.0};
  const auto operation_limits = Within(surface, containment);
  ASSERT_TRUE(operation_limits.ok()) << operation_limits.status();
  const LeftoverParams params{.operation_limits = &*operation_limits};
  for (const double x : {5.0, 9.0, 17.0})
    EXPECT_NEAR(LeftoverAt(surface, Vec3(x, 1, 0), params), std::hypot(x - 4.0, kR) - kR, kNear) << x;
  EXPECT_EQ(LeftoverAt(surface, Vec3(3, 1, 0), params), 0.0);
}

TEST(Leftover, UnderAHighestTipIsMeasuredFromTheSide) {
  // A ball that may not go higher than 5 is beside the hemisphere, where both spheres touch.
  const Surface ball = SurfaceOf(Sphere(Vec3::Zero(), 10, Half::kUpper));
  Containment low;
  low.top_z = 5.0;
  const auto under = Within(ball, low);
  ASSERT_TRUE(under.ok()) << under.status();
  const double beside = std::sqrt(13.0 * 13.0 - 8.0 * 8.0);
  EXPECT_NEAR(LeftoverAt(ball, Vec3(0, 0, 10), {.operation_limits = &*under}), std::hypot(beside, 2.0) - kR,
              kNear);
  EXPECT_NEAR(LeftoverAt(ball, Vec3(6, 0, 8), {.operation_limits = &*under}), beside - 6.0 - kR, kNear);
  // Below the sheet altogether: from beyond its edge, which the ball touches.
  const Surface sheet = SurfaceOf(Plane(6));
  low.top_z = -2.0;
  const auto below = Within(sheet, low);
  ASSERT_TRUE(below.ok()) << below.status();
  EXPECT_NEAR(LeftoverAt(sheet, Vec3::Zero(), {.operation_limits = &*below}),
              std::hypot(6.0 + std::sqrt(8.0), 1.0) - kR, kNear);
}

TEST(Leftover, BesideAClampIsMeasuredFromItsSideOrFromAboveIt) {
  // Up to 5 over the plane, 1 around it; the axis keeps R and 1 from it, or the tip 1 above it.
  const Surface surface = SurfaceOf(Plane(40));
  Containment containment;
  containment.obstacles.push_back({"clamp", Outline({{{-5, -30}, {5, -30}, {5, 30}, {-5, 30}}}), 4.0, 1.0});
  const auto operation_limits = Within(surface, containment);
  ASSERT_TRUE(operation_limits.ok()) << operation_limits.status();
  const LeftoverParams params{.operation_limits = &*operation_limits};
  EXPECT_NEAR(LeftoverAt(surface, Vec3(0, 0, 0), params), 5.0, kNear);
  EXPECT_NEAR(LeftoverAt(surface, Vec3(3, 0, 0), params), std::hypot(6.0, kR) - kR, kNear);
  EXPECT_NEAR(LeftoverAt(surface, Vec3(9.5, 0, 0), params), 0.0, kNear);
}

TEST(Leftover, WhereNothingIsAllowedIsAllThereIs) {
  const Surface surface = SurfaceOf(Plane(30));
  Containment containment;
  containment.top_z = -2.0;
  const auto operation_limits = Within(surface, containment);
  ASSERT_TRUE(operation_limits.ok()) << operation_limits.status();
  // A floor over what is allowed.
  EXPECT_DOUBLE_EQ(
      LeftoverAt(surface, Vec3::Zero(), {.floor_z = -1.0, .operation_limits = &*operation_limits}),
      surface.box.Diagonal());
}

// In a hole hardly wider than the ball, the free centres form a thread. No column beside it shows them.
TEST(Leftover, InAHoleThatTheBallJustFits) {
  const double deep = 10.0;
  for (const double play : {0.01, 0.001}) {
    const double hole = kR + play;
    const Surface surface = SurfaceOf(
        Turned({Line({0, 0}, {hole, 0}), Line({hole, 0}, {hole, deep}), Line({hole, deep}, {20, deep})}));
    const Locator locator(surface, kR);
    for (const double angle : {0.1, 1.0, 2.7, 4.4}) {
      // Of the floor beside the wall, of the wall's foot, and of the wall half way up.
      const Vec3 out(std::cos(angle), std::sin(angle), 0.0), foot = hole * out + Vec3(0, 0, 1e-3);
      const Vec3 floor = (hole - 1e-3) * out;
      const double stays = (std::sqrt(2.0) - 1.0) * kR;
      for (const auto& [p, normal] : {std::pair{floor, Vec3(0, 0, 1)}, {foot, Vec3(-out)}, {foot, out}}) {
        EXPECT_NEAR(DeepestLeftover(locator, {}, {&p, 1}, RunContext(), {&normal, 1}).leftover, stays, kNear)
            << play << " " << angle;
      }
      const Vec3 wall = foot + Vec3(0, 0, 0.5 * deep);
      EXPECT_NEAR(DeepestLeftover(locator, {}, {&wall, 1}, RunContext(), {&out, 1}).leftover, 0.0, kNear);
    }
  }
}

TEST(Leftover, IsAsBruteForceFindsIt) {
  // Columns all over the disk that could hold a nearer centre, on rough parts with folds: never much
  // farther.
  int deep = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Surface surface = SurfaceOf(RandomBspline(seed, {.size = 20.0, .amplitude = 8.0, .folds = true}));
    const Locator locator(surface, kR);
    Random random(seed);
    for (int i = 0; i < 12; ++i) {
      const auto& piece = surface.pieces[seed * 7919 % surface.pieces.size()];
      const Vec3 p = Evaluate(piece, random.Uniform(0, 1), random.Uniform(0, 1)).p;
      const double found = DeepestLeftover(locator, {}, {&p, 1}, RunContext()).leftover;
      double nearest = kInfinity;
      for (int k = 0; k < 4000; ++k) {
        const double angle = random.Uniform(0, 2 * kPi), out = (found + kR) * std::sqrt(random.Uniform(0, 1));
        const Vec2 q = Xy(p) + out * Vec2(std::cos(angle), std::sin(angle));
        const auto height = locator.Height(q, nullptr, 1e-3);
        const double up = height ? std::max(0.0, height->z - p.z()) : 0.0;
        nearest = std::min(nearest, std::hypot((q - Xy(p)).norm(), up));
      }
      EXPECT_LE(found, nearest - kR + 0.03 * nearest) << seed << " " << p.transpose();
      deep += found > 0.3 * kR;
    }
  }
  EXPECT_GT(deep, 10);
}

TEST(Leftover, OfManyPlacesIsThatOfTheDeepest) {
  const Surface surface = SurfaceOf(TwoPlanes(Radians(60), 20));
  std::vector<Vec3> places;
  double deepest = 0.0;
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const double x = random.Uniform(-2.0, 2.0);
    places.push_back({x, random.Uniform(-15, 15), std::abs(x) * std::tan(Radians(60))});
    deepest = std::max(deepest, LeftoverAt(surface, places.back()));
  }
  EXPECT_DOUBLE_EQ(DeepestLeftover(Locator(surface, kR), {}, places, RunContext()).leftover, deepest);
  EXPECT_EQ(DeepestLeftover(Locator(surface, kR), {}, {}, RunContext()).leftover, 0.0);
}

TEST(Leftover, OfTrianglesIsProvenAndThatOfTheirDeepestPlace) {
  // A valley whose bottom keeps R / cos(a) - R, and one triangle a piece that the crease is a side of.
  const double a = Radians(50);
  const Surface surface = SurfaceOf(TwoPlanes(a, 20));
  const Locator locator(surface, kR);
  LeftoverSearch search(locator, {});
  for (std::size_t piece = 0; piece < surface.pieces.size(); ++piece) {
    search.AddTriangle(piece, {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)});
    search.AddTriangle(piece, {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)});
  }
  const Deepest found = search.Find(RunContext());
  const double stays = kR / std::cos(a) - kR;
  EXPECT_TRUE(found.proven);
  EXPECT_LE(found.leftover, stays + kNear);
  EXPECT_GE(found.leftover, stays / 1.05 - 0.002 * kR);
  // Without any surface there is no leftover.
  EXPECT_EQ(LeftoverSearch(locator, {}).Find(RunContext()).leftover, 0.0);
}

}  // namespace
}  // namespace patchmill
