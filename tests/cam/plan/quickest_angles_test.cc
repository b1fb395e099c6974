// The direction of lines that takes the least time: by the choice itself, and by whole jobs.
#include "cam/plan/quickest_angles.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

RegionMap MapOf(std::vector<SlopeClass> slopes) {
  RegionMap map;
  for (const SlopeClass slope : slopes) {
    map.regions.emplace_back().id = static_cast<int>(map.regions.size()) - 1;
    map.regions.back().slope = slope;
  }
  return map;
}

std::vector<RegionChoice> OpenChoices(std::size_t n) {
  RegionChoice open;
  open.angle_open = true;
  return std::vector<RegionChoice>(n, open);
}

// 0 .. 5: which of the angles that are tried.
int Nth(double angle) { return static_cast<int>(std::lround(Degrees(angle) / 30.0)); }

TEST(QuickestAngles, EachRegionTakesItsOwn) {
  // Region 0 likes 60 degrees, region 1 120, region 2 has a fixed angle.
  std::vector<RegionChoice> choices = OpenChoices(3);
  choices[2].angle_open = false;
  choices[2].zigzag_angle = Radians(17);
  int plans = 0;
  const auto plan = [&](const std::vector<RegionChoice>& with) -> absl::StatusOr<RegionTimes> {
    ++plans;
    for (const RegionChoice& c : with) EXPECT_FALSE(c.angle_open);
    EXPECT_EQ(with[2].zigzag_angle, Radians(17));
    return RegionTimes{10.0 + std::abs(Nth(with[0].zigzag_angle) - 2),
                       10.0 + std::abs(Nth(with[1].zigzag_angle) - 4), 1.0};
  };
  const auto chosen =
      QuickestAngles(MapOf({SlopeClass::kGentle, SlopeClass::kGentle, SlopeClass::kGentle}), choices, plan);
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  EXPECT_EQ(plans, 7);
  EXPECT_NEAR(Degrees((*chosen)[0].zigzag_angle), 60.0, 1e-9);
  EXPECT_NEAR(Degrees((*chosen)[1].zigzag_angle), 120.0, 1e-9);
  EXPECT_EQ((*chosen)[2], choices[2]);
}

TEST(QuickestAngles, AMixtureThatCostsMoreIsNotTaken) {
  const auto plan = [](const std::vector<RegionChoice>& with) -> absl::StatusOr<RegionTimes> {
    const bool mixed = with[0].zigzag_angle != with[1].zigzag_angle;  // the seam between them costs
    return RegionTimes{10.0 + std::abs(Nth(with[0].zigzag_angle) - 2) + (mixed ? 9.0 : 0.0),
                       10.0 + 3.0 * std::abs(Nth(with[1].zigzag_angle) - 4)};
  };
  const auto chosen = QuickestAngles(MapOf({SlopeClass::kGentle, SlopeClass::kGentle}), OpenChoices(2), plan);
  ASSERT_TRUE(chosen.ok()) << chosen.status();
  for (const RegionChoice& c : *chosen) EXPECT_NEAR(Degrees(c.zigzag_angle), 120.0, 1e-9);
}

TEST(QuickestAngles, AnErrorEndsIt) {
  const auto plan = [](const std::vector<RegionChoice>&) -> absl::StatusOr<RegionTimes> {
    return absl::CancelledError("enough");
  };
  EXPECT_EQ(QuickestAngles(MapOf({SlopeClass::kGentle}), OpenChoices(1), plan).status().code(),
            absl::StatusCode::kCancelled);
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
    // No angle asked for is quicker.
    job.operation.angle_auto = false;
    for (int k = 0; k < 6; ++k) {
      job.operation.zigzag_angle = k * kPi / 6.0;
      EXPECT_GE(Mill(surface, job).report.motion.time, result.report.motion.time * (1.0 - 1e-9)) << k;
    }
  }
}

}  // namespace
}  // namespace patchmill
