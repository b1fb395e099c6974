// Which heights a column allows, against what is allowed at single centres.
#include "cam/location/limits/operation_limits.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kBall = 3.0, kShank = 4.0, kTolerance = 0.01;

Outline Square(double x, double y, double half) {
  return Outline({{{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}}});
}

// A hill beside a lid over a plane.
Surface Part() {
  Surface surface = SurfaceOf(Join({Plane(30), Sphere(Vec3(-12, 0, 0), 6, Half::kUpper),
                                    Single(Bilinear({5, -5, 9}, {15, -5, 9}, {5, 5, 9}, {15, 5, 9}))}));
  surface.network.join_tolerance = 1e-3;  // parts of it are surfaces of their own
  return surface;
}

std::vector<Containment> Limits(const Surface& surface) {
  std::vector<Containment> limits(5);
  limits[0].top_z = 8.0;
  limits[1].boundary = Boundary{Square(0, 0, 15), BoundaryMode::kInside, 0.5};
  limits[2].obstacles.push_back({"low", Square(6, 6, 4), 5.0, 1.0});
  limits[2].obstacles.push_back({"high", Square(9, 3, 5), 11.0, 0.5});
  limits[3].avoided.assign(surface.network.model.patches.size(), true);
  limits[3].avoided[0] = false;
  limits[3].avoid_margin = 2.0;
  limits[4] = limits[2];
  limits[4].avoided = limits[3].avoided;
  limits[4].avoid_margin = 0.5;
  limits[4].top_z = 14.0;
  limits[4].boundary = Boundary{Square(2, 0, 16), BoundaryMode::kCenter, 0.0};
  return limits;
}

// Heights, single centres and balls of centres in all columns.
void ExpectOneAnswer(const Surface& surface, const std::vector<UpperCylinder>& uppers) {
  Random random(7);
  int allowed = 0, forbidden = 0, balls = 0;
  const std::vector<Containment> all = Limits(surface);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const Containment& limits = all[n];
    SCOPED_TRACE(n);
    const auto operation_limits = OperationLimits::Make(
        surface, limits,
        {.ball_radius = kBall, .tool_radius = kShank, .uppers = uppers, .tolerance = kTolerance},
        RunContext());
    ASSERT_TRUE(operation_limits.ok()) << operation_limits.status();
    for (int i = 0; i < 400; ++i) {
      const Vec2 q(random.Uniform(-20, 20), random.Uniform(-20, 20));
      const auto heights = operation_limits->HeightsOver(q, 0.1 * kTolerance);
      for (int k = 0; k < 8; ++k) {
        const double z = random.Uniform(-5, 25);
        const bool is = operation_limits->Allows(Lift(q, z));
        ++(is ? allowed : forbidden);
        const double around = random.Uniform(0.0, 3.0);
        if (operation_limits->Forbids(Lift(q, z), around)) {
          ++balls;
          const Vec3 way(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
          EXPECT_FALSE(operation_limits->Allows(Lift(q, z) + 0.99 * around * way.normalized()));
        }
        if (!heights) {
          EXPECT_FALSE(is) << q.transpose() << " " << z;
          continue;
        }
        // Moves may be off a limit by half the tolerance; beside a ball's upright flank that is more in
        // height.
        const double flank = kTolerance / std::max(0.05, heights->normal.z());
        if (std::abs(z - heights->lowest) < flank || std::abs(z - heights->highest) < kTolerance) continue;
        EXPECT_EQ(is, heights->lowest <= z && z <= heights->highest) << q.transpose() << " " << z;
      }
    }
  }
  EXPECT_GT(allowed, 3000);
  EXPECT_GT(forbidden, 3000);
  EXPECT_GT(balls, 1000);
}

TEST(OperationLimits, HeightsOverAColumnAreThoseOfItsCentres) { ExpectOneAnswer(Part(), {}); }

TEST(OperationLimits, HeightsUnderAWideShankAreThoseOfItsCentres) {
  ExpectOneAnswer(Part(), {{kShank, 4.0}});
}

TEST(OperationLimits, HeightsUnderAHolderAreThoseOfItsCentres) {
  ExpectOneAnswer(Part(), {{kShank, 3.0}, {6.0, 6.0, UpperPart::kHolder}, {9.0, 8.0, UpperPart::kHolder}});
}

// Flutes longer than the part is high: nothing more is asked.
TEST(OperationLimits, LongFlutesLimitNothing) {
  const Surface surface = Part();
  const Containment none;
  const double height = surface.box.max.z() - surface.box.min.z();
  for (const double rise : {height - 0.1, height + 0.1}) {
    const auto operation_limits = OperationLimits::Make(
        surface, none, {.ball_radius = kBall, .tool_radius = kShank, .uppers = {{kShank, rise}}},
        RunContext());
    ASSERT_TRUE(operation_limits.ok()) << operation_limits.status();
    EXPECT_EQ(operation_limits->HasUppers(), rise < height);
    EXPECT_EQ(operation_limits->AllowsAll(), rise > height);
  }
}

}  // namespace
}  // namespace patchmill
