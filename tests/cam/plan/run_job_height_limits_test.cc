// Flats and fillets next to the lowest and the highest tip: which areas count as reachable, which are cut,
// and the time that this takes.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "tests/support/fuzz.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/profiles.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kLength = 60.0, kHigh = 2.0;

// Level at z = 0 up to x = 15, a ramp, level at z = 2 from x = 18 on: 82 mm of it.
PatchModel Ramp() {
  return Drawn({Line({0, 0}, {15, 0}), Line({15, 0}, {18, kHigh}), Line({18, kHigh}, {100, kHigh})}, kLength);
}
constexpr double kHighArea = 82.0 * kLength;

double CutLength(const JobResult& result) { return result.report.motion.cut_length; }

// A flat is not cut however little it lies above the highest tip. This is found quickly.
TEST(HeightLimits, FlatsAboveTheHighestTip) {
  const Surface surface = PlacedSurface(Ramp());
  Job job = BallJob(3.0);
  job.operation.top_z = kHigh;
  const JobResult all = MillChecked(surface, job);
  EXPECT_EQ(all.report.verify.unreachable_area[UncutReason::kAvoided], 0.0);
  for (const double below : {1e-5, 0.001, 0.006, 0.03, 0.3}) {
    SCOPED_TRACE(below);
    job.operation.top_z = kHigh - below;
    const JobResult result = MillChecked(surface, job);
    // And of the ramp what a tip at that height does not reach.
    EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kAvoided], kHighArea, 0.02 * kHighArea);
    EXPECT_LT(CutLength(result), 0.3 * CutLength(all));
    for (const Move& move : result.motion.toolpath.moves) {
      if (move.kind == MoveKind::kCut) {
        ASSERT_LE(move.to.z() - 3.0, kHigh - below + 0.005);
      }
    }
  }
}

// The finding states the height above the highest tip, not how much of the ball touches the surface there.
TEST(HeightLimits, TheVerdictSaysByHowMuch) {
  const Surface surface = PlacedSurface(Plane(8));
  const Job job = BallJob(3.0);
  VerifyParams params;
  params.floor_z = -1000.0;
  params.stock_top_z = 0.5;
  params.containment.top_z = -1.75;
  const auto report =
      VerifyProgramText(surface, job.operation.tool, Mill(surface, job).program, params, RunContext());
  ASSERT_TRUE(report.ok()) << report.status();
  int found = 0;
  for (const Diagnostic& d : report->findings) {
    if (d.code != "ABOVE_TOP") continue;
    ++found;
    EXPECT_THAT(d.message, ::testing::HasSubstr("by 1.75"));
  }
  EXPECT_GT(found, 0);
}

TEST(HeightLimits, NothingIsCutWhereAllIsAboveTheHighestTip) {
  Job job = BallJob(3.0);
  job.operation.top_z = -0.004;
  const JobResult result = Mill(PlacedSurface(Plane(15)), job);
  EXPECT_EQ(result.report.outcome, Outcome::kNothingToCut) << Describe(result);
  EXPECT_TRUE(result.program.empty());
}

// A flat below the lowest tip by more than the reach tolerance is left, and found quickly. By less, it is cut
// at the floor.
TEST(HeightLimits, FlatsBelowTheFloor) {
  const Surface surface = PlacedSurface(Ramp());
  Job job = BallJob(3.0);
  const double reach_tolerance = ReachTolerance(job.operation.tolerance);
  for (const double above :
       {0.1 * reach_tolerance, 0.9 * reach_tolerance, 1.2 * reach_tolerance, 0.03, 0.3}) {
    SCOPED_TRACE(above);
    job.operation.floor_z = above;
    const JobResult result = MillChecked(surface, job);
    // The other side of the corner keeps the ball off a strip, `blocked` wide on each side, which is CONCAVE.
    // On the ramp the floor adds as much as it is higher. Between two reasons areas are sampled coarsely.
    const double slope = std::atan2(kHigh, 3.0),
                 blocked = (3.0 * (1.0 - std::cos(slope)) - reach_tolerance) / std::sin(slope);
    const double left = 15.0 - blocked + above / std::sin(slope);
    EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kFloor],
                above > reach_tolerance ? left * kLength : 0.0, 0.15 * kLength);
    for (const Move& move : result.motion.toolpath.moves) ASSERT_GE(move.to.z() - 3.0, above - 1e-6);
  }
}

// A boss on its base, which is the lowest point. A fillet smaller than the ball by less than the reach
// tolerance is finished, whatever the floor. Beside sharper corners no area has the reason FLOOR.
TEST(HeightLimits, FilletsOnTheFloor) {
  for (const double radius : {2.9, 2.997, 2.9999, 3.0}) {
    if (kSanitized && radius != 2.997) continue;
    if (!LongTests() && radius == 2.9999) continue;
    SCOPED_TRACE(radius);
    const PatchModel boss =
        Turned({Line({0.5, 6}, {10, 6}), Line({10, 6}, {10, radius}),
                Round({10, radius}, {10, 0}, {10 + radius, 0}), Line({10 + radius, 0}, {18, 0})});
    const JobResult result = MillChecked(PlacedSurface(boss), BallJob(3.0, /*deep=*/false));
    EXPECT_EQ(result.report.verify.unreachable_area[UncutReason::kFloor], 0.0);
    EXPECT_EQ(result.report.verify.unreachable_area[UncutReason::kConcave] > 0.0, radius < 2.99);
    EXPECT_EQ(result.report.outcome == Outcome::kComplete, radius > 2.99) << Describe(result);
  }
}

TEST(HeightLimits, AHighestTipBelowTheLowestIsRefused) {
  Job job = BallJob(3.0);
  job.operation.floor_z = 2.0;
  job.operation.top_z = 1.0;
  EXPECT_THAT(std::string(ValidateJob(job).message()),
              ::testing::HasSubstr("heights.top_z_mm = 1; must be at least floor_z_mm = 2"));
  job.operation.top_z = 2.0;
  EXPECT_TRUE(ValidateJob(job).ok());
}

}  // namespace
}  // namespace patchmill
