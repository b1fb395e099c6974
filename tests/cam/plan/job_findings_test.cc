// Findings of whole jobs against closed forms.
#include "cam/plan/job_findings.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/profiles.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's
using ::testing::HasSubstr;

// Two plates 10 mm wide beside a slot 4 mm wide and 6 mm deep, into which a ball of diameter 6 does not fit.
Surface SlottedPlate() {
  return PlacedSurface(Drawn({Line({-12, 6}, {-2, 6}), Line({-2, 6}, {-2, 0}), Line({-2, 0}, {2, 0}),
                              Line({2, 0}, {2, 6}), Line({2, 6}, {12, 6})},
                             15.0));
}
constexpr double kShare = 4.0 / (4.0 + 2.0 * 10.0);  // as seen from above

TEST(UnreachedShare, IsThatOfTheSlot) {
  const Surface surface = SlottedPlate();
  Job job = BallJob(3.0);
  EXPECT_EQ(Operation().max_unreached, 0.5);
  const JobResult result = Mill(surface, job);
  EXPECT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  EXPECT_NEAR(UnreachedShare(result.report.verify, job.operation), kShare, 0.01);
}

TEST(UnreachedShare, AboveTheLimitEndsTheJob) {
  const Surface surface = SlottedPlate();
  Job job = BallJob(3.0);
  job.operation.max_unreached = kShare - 0.02;
  const JobResult result = Mill(surface, job);
  EXPECT_EQ(result.report.outcome, Outcome::kTooMuchUnreached);
  EXPECT_TRUE(result.program.empty());
  const Diagnostic& last = result.report.diagnostics.back();
  EXPECT_EQ(last.code, "TOO_MUCH_UNREACHED");
  EXPECT_THAT(last.message, ::testing::AllOf(HasSubstr("16."), HasSubstr("(CONCAVE 17 %)"),
                                             HasSubstr("at most 14.6667 %"), HasSubstr("--max-unreached")));
  job.operation.max_unreached = kShare + 0.02;
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kCompleteWhereReachable);
}

// A floor that the operation states leaves out what lies below it. The model's own lowest point does not:
// there the ball's lowest point cannot go deeper, and walls stay uncut.
TEST(UnreachedShare, CountsTheFloorUnlessItIsStated) {
  VerifyReport report;
  report.reachable_plan_area = 60.0;
  report.unreachable_plan_area[UncutReason::kFloor] = 40.0;
  Operation op;
  EXPECT_DOUBLE_EQ(UnreachedShare(report, op), 0.4);
  op.floor_z = 0.0;
  EXPECT_EQ(UnreachedShare(report, op), 0.0);
  report.unreachable_plan_area[UncutReason::kShank] = 20.0;
  EXPECT_DOUBLE_EQ(UnreachedShare(report, op), 0.25);
  for (const UncutReason own :
       {UncutReason::kUndercut, UncutReason::kAvoided, UncutReason::kStrategy, UncutReason::kOutside})
    report.unreachable_plan_area[own] = 1000.0;
  EXPECT_DOUBLE_EQ(UnreachedShare(report, op), 0.25);
}

}  // namespace
}  // namespace patchmill
