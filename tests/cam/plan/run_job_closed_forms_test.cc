// Exact shapes through the whole chain: verified, and what no ball reaches has the area that geometry says.
#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

struct Judged {
  Surface surface;
  JobResult result;
};

Judged RunAndCheck(const PatchModel& model, const Job& job) {
  Judged judged{PlacedSurface(model), {}};
  judged.result = Mill(judged.surface, job);
  Random random(7);
  CheckProgram(judged.surface, job, judged.result, random, kSanitized ? 50 : 1000);
  return judged;
}

double UnreachableRegions(const JobResult& result) {
  double area = 0.0;
  for (const Region& region : result.report.regions) {
    if (region.kind == RegionKind::kUnreachable) area += region.area;
  }
  return area;
}

// Everything is reached, and everywhere.
void ExpectComplete(const PatchModel& model, const Job& job) {
  const JobResult result = RunAndCheck(model, job).result;
  EXPECT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
  EXPECT_EQ(UnreachableRegions(result), 0.0);
  EXPECT_NEAR(result.report.verify.reachable_area, result.report.verify.total_area, 1e-6);
}

// Unreachable area, all reasons, as the verifier and as the region map have it.
void ExpectUnreachable(const JobResult& result, double area, double tolerance) {
  double verified = 0.0;
  for (const double a : result.report.verify.unreachable_area) verified += a;
  EXPECT_NEAR(verified, area, tolerance) << Describe(result);
  EXPECT_NEAR(UnreachableRegions(result), area, tolerance);
  EXPECT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable);
}

TEST(ClosedForms, LevelPlaneIsFlatToTheDigit) {
  const Job job = BallJob(3.0);
  const Judged judged = RunAndCheck(Plane(15), job);
  EXPECT_EQ(judged.result.report.outcome, Outcome::kComplete);
  for (const Move& move : judged.result.motion.toolpath.moves) {
    if (move.kind == MoveKind::kCut) {
      EXPECT_NEAR(move.to.z(), 3.0, 0.1 * job.operation.tolerance);
    }
  }
}

TEST(ClosedForms, TiltedPlaneGentleAndSteep) {
  for (const double angle : {20.0, 44.9, 45.1, 70.0}) {
    SCOPED_TRACE(angle);
    ExpectComplete(Plane(10, 0, std::tan(Radians(angle)), 0), BallJob(3.0));
  }
}

// A ball on a slope has its tip R (1 - cos a) lower than a flat one: the strip above the low border is out of
// reach when the tip must not go below the model.
TEST(ClosedForms, FloorStripOfATiltedPlane) {
  const double angle = Radians(30), radius = 3.0, half = 12.0;
  Job job = BallJob(radius, /*deep=*/false);
  const JobResult result = RunAndCheck(Plane(half, 0, std::tan(angle), 0), job).result;
  const double height = radius * (1.0 - std::cos(angle));
  const double width = height / std::sin(angle), slack = job.operation.tolerance / std::sin(angle);
  const double area = width * 2.0 * half;
  ExpectUnreachable(result, area, 2.0 * slack * 2.0 * half + 0.01 * area);
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kFloor], area,
              2.0 * slack * 2.0 * half + 0.01 * area);
}

TEST(ClosedForms, SaddleWiderThanTheBall) {
  Job job = BallJob(3.0);
  ExpectComplete(Saddle(0.05, 0.03, 12), job);
  job.operation.steep_angle = Radians(25);
  ExpectComplete(Saddle(0.05, 0.03, 12), job);
}

TEST(ClosedForms, CylinderDownToItsVerticalSides) {
  const JobResult result = RunAndCheck(Cylinder({0, 0, 0}, 10, 12, Half::kUpper), BallJob(3.0)).result;
  EXPECT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
}

TEST(ClosedForms, BowlJustWiderThanTheBall) {
  ExpectComplete(Paraboloid(0.12, 8), BallJob(3.0));  // smallest concave radius 1 / 0.24 = 4.17 mm
}

// The ball rests on both planes at once at R tan a from the crease (less what the tolerance forgives).
TEST(ClosedForms, ValleyOfTwoPlanesAtSeveralFeedAngles) {
  const double radius = 3.0, half = 10.0;
  for (const double slope : {25.0, 40.0, 60.0}) {
    for (const double feed : {0.0, 30.0, 90.0}) {
      SCOPED_TRACE(::testing::Message() << "slope " << slope << ", feed " << feed);
      Job job = BallJob(radius);
      job.operation.zigzag_angle = Radians(feed);
      job.operation.scallop = 0.02;
      const JobResult result = RunAndCheck(TwoPlanes(Radians(slope), half), job).result;
      const double a = Radians(slope);
      const double strip = radius * std::tan(a) - ReachTolerance(job.operation.tolerance) / std::sin(2.0 * a);
      const double area = 2.0 * strip * 2.0 * half;
      ExpectUnreachable(result, area, 0.01 * area);
      if (kSanitized) break;
    }
  }
}

TEST(ClosedForms, RidgeOfTwoPlanes) {
  for (const double slope : {30.0, 60.0}) ExpectComplete(TwoPlanes(-Radians(slope), 10.0), BallJob(3.0));
}

// A ball of radius R on a plane touches the hemisphere (radius r) at the distance sqrt(r^2 + 2 r R) of its
// centre; on the hemisphere nothing lower than r R / (r + R) is reached. With R - t for the free ball:
TEST(ClosedForms, HemisphereOnAPlane) {
  const double r = 6.0, radius = 2.5, half = 15.0;
  Job job = BallJob(radius);
  job.operation.scallop = 0.02;
  const JobResult result = RunAndCheck(Join({Sphere({0, 0, 0}, r, Half::kUpper), Plane(half)}), job).result;
  const double t = ReachTolerance(job.operation.tolerance);
  const double on_plane = kPi * ((r + radius - t) * (r + radius - t) - radius * radius);
  const double on_sphere = 2.0 * kPi * r * r * (radius - t) / (r + radius);
  ExpectUnreachable(result, on_plane + on_sphere, 0.01 * (on_plane + on_sphere));
}

// Fillets are left along the foot of the block: floor nearer than R to a wall, wall lower than R.
TEST(ClosedForms, BlockWithVerticalWalls) {
  const double half = 6.0, height = 5.0, radius = 2.0;
  Job job = BallJob(radius);
  job.operation.scallop = 0.02;
  const JobResult result = RunAndCheck(Block(half, height, 14.0), job).result;
  const double reach = radius - ReachTolerance(job.operation.tolerance);
  const double on_floor = 8.0 * half * reach + kPi * reach * reach, on_walls = 8.0 * half * reach;
  ExpectUnreachable(result, on_floor + on_walls, 0.01 * (on_floor + on_walls));
}

}  // namespace
}  // namespace patchmill
