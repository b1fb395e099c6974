// The direction of lines that takes the least time: by the choice itself, and by whole jobs.
#include "cam/plan/quickest_angles.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error_details.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/profiles.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

RegionMap MapOf(std::vector<SlopeClass> slopes) {
  RegionMap map;
  for (const SlopeClass slope : slopes) {
    Region& region = map.regions.emplace_back();
    region.id = RegionId(map.regions.size() - 1);
    region.slope = slope;
  }
  return map;
}

RegionChoices OpenChoices(std::size_t n) {
  return {std::vector<RegionChoice>(n), std::vector<OpenChoice>(n, {.angle = true})};
}

std::vector<CircularTrial> NoCircles(std::size_t n) { return std::vector<CircularTrial>(n); }

// Degrees between two directions of lines.
double Apart(double a, double b) {
  const double d = std::abs(Degrees(a) - b);
  return std::min(d, 180.0 - d);
}

// Plans that exceed a limit are not chosen. If all exceed it, the plan of the caller reports the error.
TEST(QuickestAngles, PlansBeyondALimitAreNoChoice) {
  const auto angles = [](double from, double to) {
    return QuickestAngles(MapOf({SlopeClass::kGentle}), OpenChoices(1), NoCircles(1),
                          [&](const std::vector<RegionChoice>& with) -> absl::StatusOr<RegionTimes> {
                            const double angle = Degrees(with[0].zigzag_angle);
                            if (angle < from - 1e-9 || angle > to + 1e-9)
                              return LimitPassedError({"cut_length_mm", 1.0, 2.0}, "too long");
                            return RegionTimes{10.0 + Apart(with[0].zigzag_angle, 0.0)};
                          });
  };
  const auto some = angles(80.0, 100.0);
  ASSERT_TRUE(some.ok()) << some.status();
  EXPECT_GE(Degrees((*some)[0].zigzag_angle), 80.0);
  EXPECT_LE(Degrees((*some)[0].zigzag_angle), 100.0);
  EXPECT_TRUE(angles(200.0, 210.0).ok());
  const auto broken = QuickestAngles(
      MapOf({SlopeClass::kGentle}), OpenChoices(1), NoCircles(1),
      [](const std::vector<RegionChoice>&) -> absl::StatusOr<RegionTimes> { return absl::CancelledError(); });
  EXPECT_EQ(broken.status().code(), absl::StatusCode::kCancelled);
}

TEST(QuickestAngles, EachRegionTakesItsOwn) {
  // Best angles of two regions, degrees. The third region has a fixed angle, the fourth is cut by contours.
  for (const auto& [first, second] : {std::pair{60.0, 120.0}, {53.0, 118.0}, {178.0, 20.0}, {7.0, 16.0}}) {
    RegionChoices choices = OpenChoices(4);
    choices.open[2].angle = false;
    choices.choices[2].zigzag_angle = Radians(17);
    int plans = 0;
    const auto plan = [&](const std::vector<RegionChoice>& with) -> absl::StatusOr<RegionTimes> {
      ++plans;
      for (const RegionChoice& c : with) {
        EXPECT_GE(c.zigzag_angle, 0.0);
        EXPECT_LT(c.zigzag_angle, kPi);
      }
      EXPECT_EQ(with[2].zigzag_angle, Radians(17));
      return RegionTimes{10.0 + Apart(with[0].zigzag_angle, first),
                         10.0 + Apart(with[1].zigzag_angle, second), 1.0, 5.0};
    };
    const auto chosen = QuickestAngles(
        MapOf({SlopeClass::kGentle, SlopeClass::kGentle, SlopeClass::kGentle, SlopeClass::kSteep}), choices,
        NoCircles(4), plan);
    ASSERT_TRUE(chosen.ok()) << chosen.status();
    EXPECT_LE(plans, kQuickestAnglePlans);
    EXPECT_LE(Apart((*chosen)[0].zigzag_angle, first), 0.5 * 3.75 + 1e-9) << first;
    EXPECT_LE(Apart((*chosen)[1].zigzag_angle, second), 0.5 * 3.75 + 1e-9) << second;
    EXPECT_EQ((*chosen)[2], choices.choices[2]);
  }
}

TEST(QuickestAngles, AMixtureThatCostsMoreIsNotTaken) {
  const auto plan = [](const std::vector<RegionChoice>& with) -> absl::StatusOr<RegionTimes> {
    const bool mixed = with[0].zigzag_angle != with[1].zigzag_angle;  // the seam between them costs
    return RegionTimes{10.0 + Apart(with[0].zigzag_angle, 60.0) / 30.0 + (mixed ? 9.0 : 0.0),
                       10.0 + Apart(with[1].zigzag_angle, 127.0) / 10.0};
  };
  const auto chosen =
      QuickestAngles(MapOf({SlopeClass::kGentle, SlopeClass::kGentle}), OpenChoices(2), NoCircles(2), plan);
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  for (const RegionChoice& c : *chosen) EXPECT_NEAR(Degrees(c.zigzag_angle), 127.5, 1e-9);
}

// Components that have circles anyhow, one more that may have them, and one with lines whatever is tried: it
// takes its best angle, and the others stand in their order.
TEST(QuickestAngles, CirclesOnAPartOfARegion) {
  const CircularComponent first{ComponentId(1), {Vec2(1, 2), 3.0, 12.0}},
      second{ComponentId(2), {Vec2(40, 2), 3.0, 9.0}}, third{ComponentId(5), {Vec2(80, 2), 3.0, 9.0}};
  RegionChoices choices = OpenChoices(1);
  choices.choices[0].around = {first, third};
  const auto plan = [&](const std::vector<RegionChoice>& with) -> absl::StatusOr<RegionTimes> {
    EXPECT_FALSE(with[0].all_circular);
    return RegionTimes{(with[0].around.size() == 3 ? 9.0 : 10.0) + Apart(with[0].zigzag_angle, 90.0) / 10.0};
  };
  const auto chosen = QuickestAngles(MapOf({SlopeClass::kGentle}), choices, {{{second}, false}}, plan);
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  EXPECT_EQ((*chosen)[0].around, (std::vector<CircularComponent>{first, second, third}));
  EXPECT_NEAR(Degrees((*chosen)[0].zigzag_angle), 90.0, 1e-9);
}

TEST(QuickestAngles, AnErrorEndsIt) {
  const auto plan = [](const std::vector<RegionChoice>&) -> absl::StatusOr<RegionTimes> {
    return absl::CancelledError("enough");
  };
  EXPECT_EQ(QuickestAngles(MapOf({SlopeClass::kGentle}), OpenChoices(1), NoCircles(1), plan).status().code(),
            absl::StatusCode::kCancelled);
}

// Of two regions that may have circles one is quicker with them, and one with lines; the third has none to
// try.
TEST(QuickestAngles, CirclesWhereTheyAreQuicker) {
  std::vector<CircularTrial> circles = NoCircles(3);
  circles[0] = {{{ComponentId(0), {Vec2(1, 2), 3.0, 12.0}}}, true};
  circles[1] = {{{ComponentId(1), {Vec2(40, 2), 3.0, 9.0}}}, true};
  int plans = 0;
  const auto plan = [&](const std::vector<RegionChoice>& with) -> absl::StatusOr<RegionTimes> {
    ++plans;
    EXPECT_TRUE(with[2].around.empty());
    for (const RegionChoice& c : with) EXPECT_EQ(c.all_circular, !c.around.empty());
    const auto time = [&](std::size_t id, double round, double best_angle) {
      return with[id].all_circular ? round : 10.0 + Apart(with[id].zigzag_angle, best_angle) / 10.0;
    };
    return RegionTimes{time(0, 9.9, 33.0), time(1, 10.5, 48.0), time(2, 0.0, 7.0)};
  };
  const auto chosen = QuickestAngles(MapOf({SlopeClass::kGentle, SlopeClass::kGentle, SlopeClass::kGentle}),
                                     OpenChoices(3), circles, plan);
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  EXPECT_LE(plans, kQuickestAnglePlans);
  EXPECT_EQ((*chosen)[0].around, circles[0].more);
  EXPECT_TRUE((*chosen)[1].around.empty());
  EXPECT_LE(Apart((*chosen)[1].zigzag_angle, 48.0), 0.5 * 3.75 + 1e-9);
  EXPECT_LE(Apart((*chosen)[2].zigzag_angle, 7.0), 0.5 * 3.75 + 1e-9);
}

// A ridge that lies askew: none of the angles that are tried first.
TEST(QuickestAngles, AlongARidgeThatLiesAskew) {
  for (const double askew : {17.0, 100.0}) {
    Eigen::Affine3d turn = Eigen::Affine3d::Identity();
    turn.rotate(Eigen::AngleAxisd(Radians(askew), Vec3::UnitZ()));
    const Surface surface = PlacedSurface(Transformed(Quadratic(0.0, -0.03, 10.0), turn));
    Job job = BallJob(3.0);
    job.operation.scallop = 0.02;
    job.operation.angle_auto = true;
    const JobResult result = Mill(surface, job);
    ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
    ASSERT_FALSE(result.report.choices.empty());
    EXPECT_LE(Apart(result.report.choices.front().zigzag_angle, askew), 4.0) << askew;
    job.operation.angle_auto = false;
    for (int k = 0; k < 6; ++k) {
      job.operation.zigzag_angle = k * kPi / 6.0;
      EXPECT_GT(Mill(surface, job).report.motion.time, 1.02 * result.report.motion.time) << askew << " " << k;
    }
  }
}

// By the estimate circles are hardly shorter around so wide a ring; they are quicker, for they are closed.
TEST(QuickestAngles, CirclesAroundAWideRing) {
  const Surface surface = PlacedSurface(Turned({Line({4, 0}, {40, -7.2})}));
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  EXPECT_TRUE(Mill(surface, job).report.choices.front().around.empty());
  job.operation.angle_auto = true;
  const JobResult result = Mill(surface, job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  EXPECT_TRUE(result.report.choices.front().all_circular);
  job.operation.round_lines = false;
  EXPECT_LT(result.report.motion.time, 0.97 * Mill(surface, job).report.motion.time);
}

// Widest steps, fewest lines: along a ridge, which bends across them, and across a hollow, which would bend
// towards the ball.
TEST(QuickestAngles, AlongARidgeAcrossAHollow) {
  for (const bool ridge : {true, false}) {
    const Surface surface = PlacedSurface(Quadratic(ridge ? -0.02 : 0.02, 0.0, 10.0));
    Job job = BallJob(3.0);
    job.operation.scallop = 0.02;
    job.operation.angle_auto = true;
    const JobResult result = Mill(surface, job);
    ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
    ASSERT_FALSE(result.report.choices.empty());
    EXPECT_NEAR(Degrees(result.report.choices.front().zigzag_angle), ridge ? 90.0 : 0.0, 1e-9);
    Random random(5);
    CheckProgram(surface, job, result, random, 1000);
    // No given angle is quicker.
    job.operation.angle_auto = false;
    for (int k = 0; k < 6; ++k) {
      job.operation.zigzag_angle = k * kPi / 6.0;
      EXPECT_GE(Mill(surface, job).report.motion.time, result.report.motion.time * (1.0 - 1e-9)) << k;
    }
  }
}

}  // namespace
}  // namespace patchmill
