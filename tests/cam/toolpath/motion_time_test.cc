#include "cam/toolpath/motion_time.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

Machine Cube(double acceleration = 500.0) {
  Machine machine;
  for (MachineAxis& axis : machine.axes) axis = {-500.0, 500.0, 12000.0, 6000.0, acceleration};
  machine.junction_deviation = 0.0;
  return machine;
}

double Sum(const std::vector<double>& times) { return std::accumulate(times.begin(), times.end(), 0.0); }

// v = 20 mm/s, a = 500 mm/s2: ramps of 0.04 s and 0.4 mm each.
TEST(MotionTime, OneMoveIsATrapezoid) {
  EXPECT_NEAR(Sum(MoveTimes({{{Vec3(10, 0, 0), 1200.0, false}}}, Cube())), 2 * 0.04 + (10 - 0.8) / 20, 1e-12);
}

// Too short for its feed: a triangle.
TEST(MotionTime, AShortMoveIsATriangle) {
  EXPECT_NEAR(Sum(MoveTimes({{{Vec3(0, 0, -0.2), 1200.0, false}}}, Cube())), 2 * std::sqrt(0.2 / 500), 1e-12);
}

TEST(MotionTime, RapidsAreAsFastAsTheirAxesAllow) {
  // Along the diagonal both axes run at 200 mm/s, with 500 mm/s2 each.
  const double speed = 200 * std::sqrt(2.0), a = 500 * std::sqrt(2.0), length = 1000 * std::sqrt(2.0);
  EXPECT_NEAR(Sum(MoveTimes({{{Vec3(1000, 1000, 0), 0.0, true}}}, Cube())),
              2 * speed / a + (length - speed * speed / a) / speed, 1e-9);
}

// Straight on there is no corner, however the way is divided.
TEST(MotionTime, DividedMovesTakeNoLonger) {
  std::vector<TimedMove> parts(97, {Vec3(3, 4, 0) / 97.0 * 6.0, 1500.0, false});
  const std::vector<TimedMove> whole = {{Vec3(18, 24, 0), 1500.0, false}};
  EXPECT_NEAR(Sum(MoveTimes(parts, Cube())), Sum(MoveTimes(whole, Cube())), 1e-9);
}

TEST(MotionTime, WithoutDeviationCornersStop) {
  const std::vector<TimedMove> one = {{Vec3(10, 0, 0), 1200.0, false}};
  const std::vector<TimedMove> corner = {{Vec3(10, 0, 0), 1200.0, false}, {Vec3(0, 10, 0), 1200.0, false}};
  EXPECT_NEAR(Sum(MoveTimes(corner, Cube())), 2.0 * Sum(MoveTimes(one, Cube())), 1e-12);
}

// A corner of 90 degrees with a deviation d is passed at v^2 = a d s / (1 - s), s = sqrt(1/2).
TEST(MotionTime, CornersArePassedAtTheirSpeed) {
  Machine machine = Cube();
  machine.junction_deviation = 0.02;
  const double s = std::sqrt(0.5), corner = std::sqrt(500 * 0.02 * s / (1 - s));
  ASSERT_LT(corner, 20.0);
  const std::vector<double> times =
      MoveTimes({{{Vec3(10, 0, 0), 1200.0, false}, {Vec3(0, 10, 0), 1200.0, false}}}, machine);
  const double ramp = (400 - corner * corner) / 1000;  // mm, from 20 mm/s down to the corner
  const double expected = 0.04 + (20 - corner) / 500 + (10 - 0.4 - ramp) / 20;
  EXPECT_NEAR(times[0], expected, 1e-12);
  EXPECT_NEAR(times[1], expected, 1e-12);
}

TEST(MotionTime, TurningBackStops) {
  Machine machine = Cube();
  machine.junction_deviation = 1.0;
  const std::vector<TimedMove> one = {{Vec3(10, 0, 0), 1200.0, false}};
  const std::vector<TimedMove> back = {{Vec3(10, 0, 0), 1200.0, false}, {Vec3(-10, 0, 0), 1200.0, false}};
  EXPECT_NEAR(Sum(MoveTimes(back, machine)), 2.0 * Sum(MoveTimes(one, machine)), 1e-9);
}

// A slow axis slows the moves that use it, in proportion.
TEST(MotionTime, ASlowAxisCounts) {
  Machine machine = Cube();
  machine.axes[2].feed = 300.0;
  EXPECT_NEAR(Sum(MoveTimes({{{Vec3(30, 0, -40), 6000.0, false}}}, machine)),
              50.0 / (5.0 / 0.8) + (5.0 / 0.8) / (500 / 0.8), 1e-9);
}

// Round a circle faster than its axes can turn: the speed settles at v^2 = a r.
TEST(MotionTime, CirclesKeepTheAccelerationOfTheAxes) {
  Machine machine = Cube(400.0);
  machine.junction_deviation = 0.005;
  Toolpath path;
  path.moves.push_back({.kind = MoveKind::kRapid, .to = Vec3(9, 0, 0)});
  for (int turn = 0; turn < 20; ++turn) {
    path.moves.push_back(
        {.kind = MoveKind::kCut, .to = Vec3(9, 0, 0), .feed = 6000.0, .region = RegionId(1)});
    path.moves.back().arc = Arc{ArcPlane::kXy, Vec2::Zero(), false};
  }
  const ToolpathTimes times = TimesOn(machine, path, 3);
  const double expected = 20 * 2 * kPi * 9 / std::sqrt(400.0 * 9);
  // Chords in other directions than an axis may turn faster, by the root of the root of 2 at most.
  EXPECT_LT(times.total, 1.02 * expected);
  EXPECT_GT(times.total, 0.98 * expected / std::sqrt(std::sqrt(2.0)));
  EXPECT_EQ(times.of_kind[MoveKind::kCut], times.total);
  ASSERT_EQ(times.of_region.size(), 3u);
  EXPECT_EQ(times.of_region[1], times.total);
}

TEST(MotionTime, NothingTakesNoTime) {
  EXPECT_TRUE(MoveTimes({}, Cube()).empty());
  EXPECT_EQ(Sum(MoveTimes({{{Vec3::Zero(), 100.0, false}}}, Cube())), 0.0);
}

}  // namespace
}  // namespace patchmill
