// Where a ball reaches less than a square of its step-over there is nothing to cut, and that is no success.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's
using ::testing::HasSubstr;

// 60 x 40 mm, walls of 25 mm around a floor, open above.
PatchModel Box() {
  const auto wall = [](const Vec3& a, const Vec3& b) {
    const Vec3 up(0, 0, 25);
    return Single(Bilinear(a, a + up, b, b + up));
  };
  const Vec3 p(-30, -20, 0), q(30, -20, 0), r(30, 20, 0), s(-30, 20, 0);
  return Join({Single(Bilinear(p, s, q, r)), wall(p, q), wall(q, r), wall(r, s), wall(s, p)});
}

Job JobOf(double diameter, double scallop = 0.01) {
  Job job = BallJob(0.5 * diameter, /*deep=*/false);
  job.operation.scallop = scallop;
  return job;
}

void ExpectNothing(const JobResult& result) {
  EXPECT_EQ(result.report.outcome, Outcome::kNothingToCut) << Describe(result);
  EXPECT_TRUE(result.program.empty());
  EXPECT_TRUE(result.motion.toolpath.moves.empty());
  EXPECT_EQ(result.report.point_count, 0);
  EXPECT_EQ(result.report.motion.time, 0.0);
  int said = 0;
  for (const Diagnostic& d : result.report.diagnostics) {
    if (d.code != "NOTHING_TO_CUT") continue;
    ++said;
    EXPECT_THAT(d.message, HasSubstr("--scale"));
  }
  EXPECT_EQ(said, 1);
}

// A ball that rolls over the rims of the box and touches nothing else, and one that fits between the walls.
TEST(NothingToCut, RimsAloneAreNoSurface) {
  const Surface surface = PlacedSurface(Box());
  const JobResult large = Mill(surface, JobOf(100.0));
  ExpectNothing(large);
  EXPECT_EQ(large.report.verify.reachable_area, 0.0);
  const JobResult small = Mill(surface, JobOf(10.0));
  EXPECT_EQ(small.report.outcome, Outcome::kCompleteWhereReachable) << Describe(small);
}

// The same dome ever larger, from far below a step to many steps.
TEST(NothingToCut, LessThanASquareOfTheStepOver) {
  const double square = 4.0 * 0.01 * (6.0 - 0.01);
  int nothing = 0, cut = 0;
  for (const double half : {0.03, 0.1, 0.2, 0.3, 0.6, 2.0}) {
    const Surface surface = PlacedSurface(Paraboloid(-0.2 / half, half));
    Job job = JobOf(6.0);
    job.operation.floor_z = -10.0;
    const JobResult result = Mill(surface, job);
    const double reached = result.report.verify.reachable_area;
    if (reached < square) {
      ExpectNothing(result);
      ++nothing;
    } else {
      EXPECT_NE(result.report.outcome, Outcome::kNothingToCut) << half << " " << Describe(result);
      EXPECT_FALSE(result.program.empty());
      ++cut;
    }
  }
  EXPECT_GE(nothing, 2);
  EXPECT_GE(cut, 2);
}

// A finer scallop has a smaller step-over, so that the same area is cut.
TEST(NothingToCut, GoesByTheScallop) {
  const Surface surface = PlacedSurface(Plane(0.2));
  ExpectNothing(Mill(surface, JobOf(6.0, 0.01)));  // 0.16 of 0.24 mm2
  const JobResult fine = Mill(surface, JobOf(6.0, 0.005));
  EXPECT_EQ(fine.report.outcome, Outcome::kComplete) << Describe(fine);
}

// As small a part of a large plane.
TEST(NothingToCut, HoldsForASelectionToo) {
  const Surface surface = PlacedSurface(Plane(20));
  Job job = JobOf(6.0);
  job.operation.selection.boundary_mode = BoundaryMode::kContact;
  job.operation.selection.boundary = {{{0, 0}, {0.4, 0}, {0.4, 0.4}, {0, 0.4}}};
  ExpectNothing(Mill(surface, job));
  job.operation.selection.boundary = {{{0, 0}, {0.6, 0}, {0.6, 0.6}, {0, 0.6}}};
  const JobResult larger = Mill(surface, job);
  EXPECT_FALSE(larger.program.empty()) << Describe(larger);
}

}  // namespace
}  // namespace patchmill
