#include "cam/toolpath/linuxcnc_times.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "cam/toolpath/motion_time.h"

namespace patchmill {
namespace {

constexpr double kAcceleration = 500.0;  // mm/s^2 of each axis
const double kAcross = std::sqrt(0.75);

Machine Cube() {
  Machine machine;
  for (MachineAxis& axis : machine.axes) axis = {-500.0, 500.0, 12000.0, 6000.0, kAcceleration};
  return machine;
}

Toolpath From(const Vec3& place) {
  Toolpath path;
  path.moves.push_back({.kind = MoveKind::kRapid, .to = place});
  return path;
}

void Add(Toolpath& path, const Vec3& to, double feed, MoveKind kind = MoveKind::kCut) {
  path.moves.push_back({.kind = kind, .to = to, .feed = feed});
}

void AddArc(Toolpath& path, const Vec3& to, double feed, const Arc& arc) {
  Add(path, to, feed);
  path.moves.back().arc = arc;
}

double Seconds(const Toolpath& path, double tolerance = 0.003) {
  const std::vector<double> times = LinuxCncTimes(Cube(), path, {.tolerance = tolerance});
  return std::accumulate(times.begin(), times.end(), 0.0);
}

// From rest to rest at 20 mm/s, mm and s.
double Rests(double length, double acceleration) { return length / 20.0 + 20.0 / acceleration; }

TEST(LinuxCncTimes, TheLastMoveHasHalfOfItsAcceleration) {
  Toolpath path = From(Vec3::Zero());
  Add(path, Vec3(10, 0, 0), 1200.0);
  EXPECT_NEAR(Seconds(path), Rests(10.0, 0.5 * kAcceleration), 1e-12);
}

TEST(LinuxCncTimes, RapidsAndFeedsMeetAtRest) {
  Toolpath path = From(Vec3::Zero());
  Add(path, Vec3(2, 0, 0), 0.0, MoveKind::kRapid);
  Add(path, Vec3(12, 0, 0), 1200.0);
  EXPECT_NEAR(Seconds(path), 2.0 * std::sqrt(2.0 / kAcceleration) + Rests(10.0, 0.5 * kAcceleration), 1e-12);
}

TEST(LinuxCncTimes, TurningBackAndExactStopsAreAtRest) {
  Toolpath back = From(Vec3::Zero());
  Add(back, Vec3(10, 0, 0), 1200.0);
  Add(back, Vec3::Zero(), 1200.0);
  const double both = Rests(10.0, kAcceleration) + Rests(10.0, 0.5 * kAcceleration);
  EXPECT_NEAR(Seconds(back), both, 1e-12);
  Toolpath corner = From(Vec3::Zero());
  Add(corner, Vec3(10, 0, 0), 1200.0);
  Add(corner, Vec3(10, 10, 0), 1200.0);
  EXPECT_NEAR(Seconds(corner, 0.0), both, 1e-12);
  EXPECT_LT(Seconds(corner), both);
}

// Straight on there is no corner, however the way is divided. The last part alone brakes more slowly.
TEST(LinuxCncTimes, DividedMovesPassTheirCorners) {
  Toolpath path = From(Vec3::Zero());
  for (int k = 1; k <= 20; ++k) Add(path, Vec3(k, 0, 0), 1200.0);
  EXPECT_NEAR(Seconds(path), 20.0 / 20.0 + 0.5 * 20.0 / kAcceleration + 0.5 * 20.0 / (0.5 * kAcceleration),
              1e-12);
}

// An arc of radius r is off a corner of 90 degrees by r (sqrt(2) - 1), and takes r of both moves. It is
// driven at v^2 = sqrt(3) / 2 a r.
TEST(LinuxCncTimes, CornersAreRoundedWithinTheTolerance) {
  const double tolerance = 0.05, r = tolerance / (std::sqrt(2.0) - 1.0);
  const double v = std::sqrt(kAcross * kAcceleration * r);
  ASSERT_LT(v, 20.0);
  Toolpath path = From(Vec3::Zero());
  Add(path, Vec3(10, 0, 0), 1200.0);
  Add(path, Vec3(10, 10, 0), 1200.0);
  const auto leg = [&](double acceleration, double other) {
    const double ramps = (400.0 - v * v) / (2.0 * acceleration) + 400.0 / (2.0 * other);
    return (20.0 - v) / acceleration + 20.0 / other + (10.0 - r - ramps) / 20.0;
  };
  const double half = 0.5 * kAcceleration;
  EXPECT_NEAR(Seconds(path, tolerance),
              leg(kAcceleration, kAcceleration) + 0.5 * kPi * r / v + leg(half, half), 1e-9);
}

// Round and round, faster than the axes can turn: the speed settles at v^2 = sqrt(3) / 2 a r.
TEST(LinuxCncTimes, CirclesKeepTheirAccelerationAcross) {
  Toolpath path = From(Vec3(9, 0, 0));
  for (int turn = 0; turn < 20; ++turn)
    AddArc(path, Vec3(9, 0, 0), 6000.0, {ArcPlane::kXy, Vec2::Zero(), false});
  const double way = 20 * 2 * kPi * 9, v = std::sqrt(kAcross * kAcceleration * 9);
  // Half of the acceleration is left along the arc. The last circle has half of both.
  const double last = std::sqrt(0.5) * v, along = 0.5 * kAcceleration;
  const double circle = way / 20;
  const double speeds_up = v / along + (way - circle - (v * v + v * v - last * last) / (2 * along)) / v;
  const double slows_down = (v - last) / along;
  const double ends = last / (0.5 * along) + (circle - last * last / along) / last;
  EXPECT_NEAR(Seconds(path), speeds_up + slows_down + ends, 1e-9);
}

// An arc tangent to a line is driven on at speed. If the line leaves the plane of the arc, though by a
// thousandth of a radian, both all but rest between them.
TEST(LinuxCncTimes, CornersOutOfThePlaneOfAnArcAreNotRounded) {
  const auto seconds = [](double beside) {
    Toolpath path = From(Vec3(-10, -beside, 0));
    Add(path, Vec3(0, 0, 0), 1200.0);
    AddArc(path, Vec3(10, 0, 10), 1200.0, {ArcPlane::kZx, Vec2(10, 0), true});
    return Seconds(path);
  };
  const double along = 0.5 * kAcceleration;  // of the arc; half of it as the last move
  EXPECT_NEAR(seconds(0.0), (10 + 5 * kPi) / 20 + 0.5 * 20 / kAcceleration + 0.5 * 20 / (0.5 * along), 1e-9);
  EXPECT_GT(seconds(0.01), seconds(0.0) + 0.5 * 20 / (0.5 * kAcceleration));
}

// Arcs whose ends fall together in the decimals of the program are no circles.
TEST(LinuxCncTimes, AShortArcIsNoCircle) {
  Toolpath path = From(Vec3(5, 0, 0));
  AddArc(path, Vec3(5, 0.00003, 0), 1200.0, {ArcPlane::kXy, Vec2::Zero(), false});
  Add(path, Vec3(15, 0, 0), 1200.0);
  EXPECT_LT(Seconds(path), 1.0);
}

// A quarter of a helix is as long as it is steep, and its third axis limits it.
TEST(LinuxCncTimes, HelicesKeepTheirThirdAxis) {
  Machine machine = Cube();
  machine.axes[2].feed = 60.0;  // 1 mm/s
  Toolpath path = From(Vec3(5, 0, 0));
  AddArc(path, Vec3(0, 5, 10), 6000.0, {ArcPlane::kXy, Vec2::Zero(), false});
  const double seconds = LinuxCncTimes(machine, path, {.tolerance = 0.003})[1];
  EXPECT_GT(seconds, 10.0);
  EXPECT_LT(seconds, 10.1);
}

TEST(LinuxCncTimes, SumUpByKind) {
  Toolpath path = From(Vec3::Zero());
  Add(path, Vec3(50, 0, 0), 0.0, MoveKind::kRapid);
  Add(path, Vec3(50, 0, -5), 400.0, MoveKind::kPlunge);
  const LinuxCncPlanner planner{.tolerance = 0.003};
  const std::vector<double> times = LinuxCncTimes(Cube(), path, planner);
  const ToolpathTimes sums = TimesOn(Cube(), path, 0, planner);
  EXPECT_EQ(sums.of_kind[MoveKind::kRapid], times[1]);
  EXPECT_EQ(sums.of_kind[MoveKind::kPlunge], times[2]);
  EXPECT_EQ(sums.total, times[1] + times[2]);
}

TEST(LinuxCncTimes, NothingTakesNoTime) {
  EXPECT_TRUE(LinuxCncTimes(Cube(), Toolpath(), {}).empty());
  EXPECT_EQ(Seconds(From(Vec3(1, 2, 3))), 0.0);
}

}  // namespace
}  // namespace patchmill
