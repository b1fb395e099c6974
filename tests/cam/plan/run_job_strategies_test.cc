// Other settings of a job: forced strategies, stock to leave, a floor.
#include <gtest/gtest.h>

#include "core/surface/closest.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/profiles.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

int CountPasses(const JobResult& result, PassKind kind) {
  int count = 0;
  for (const CutterPath& path : result.motion.passes) count += path.kind == kind;
  return count;
}

// A hill steep on its flanks and flat on its top: neither kind of pass can do
// it alone.
PatchModel Hill() {
  return Single(InterpolatedHeights(
      [](double x, double y) { return 9.0 * std::exp(-(x * x + y * y) / 40.0); }, -14, 14, -14, 14, 8, 8));
}

TEST(Strategies, AutoUsesBoth) {
  Job job = BallJob(3.0);
  job.operation.scallop = 0.02;
  const Surface surface = PlacedSurface(Hill());
  const JobResult result = Mill(surface, job);
  Random random(1);
  CheckProgram(surface, job, result, random, 500);
  EXPECT_GT(CountPasses(result, PassKind::kContour), 0);
  EXPECT_GT(CountPasses(result, PassKind::kZigzag), 0);
  EXPECT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
}

TEST(Strategies, ForcedContoursLeaveTheFlatTopAndSaySo) {
  Job job = BallJob(3.0);
  job.operation.scallop = 0.02;
  job.operation.strategy = Strategy::kContour;
  const Surface surface = PlacedSurface(Hill());
  const JobResult result = Mill(surface, job);
  Random random(2);
  CheckProgram(surface, job, result, random, 500);
  EXPECT_EQ(CountPasses(result, PassKind::kZigzag), 0);
  EXPECT_GT(CountPasses(result, PassKind::kContour), 0);
  EXPECT_TRUE(result.report.verify.gouge_ok);
  EXPECT_GT(result.report.verify.unreachable_area[UncutReason::kStrategy], 1.0) << Describe(result);
  EXPECT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable);
}

// Passes along borders and rest passes as well, and none of them the other way.
TEST(Strategies, OneWayIsAllOfIt) {
  Job job = BallJob(3.0);
  job.operation.scallop = 0.02;
  job.operation.one_way = true;
  job.operation.zigzag_angle = Radians(180.0);
  const JobResult result = Mill(PlacedSurface(Turned({Line({2, 1}, {15, 0})})), job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  int beside = 0;
  for (const CutterPath& pass : result.motion.passes) {
    const Vec3 d = pass.points.back().center - pass.points.front().center;
    if (pass.closed || std::abs(d.x()) < 0.3 * d.norm()) continue;
    EXPECT_LT(d.x(), 0.0);
    beside += pass.kind != PassKind::kZigzag ? 1 : 0;
  }
  EXPECT_GE(beside, 3);
}

// The stock to leave stays everywhere: no feed move comes nearer than R + L -
// tolerance, and at reachable points no more than L + scallop + tolerance
// stays.
TEST(Strategies, StockToLeaveIsLeft) {
  Job job = BallJob(2.5);
  job.operation.scallop = 0.02;
  job.operation.leave = 0.3;
  const Surface surface = PlacedSurface(Join({Sphere({0, 0, 0}, 6, Half::kUpper), Plane(14)}));
  const JobResult result = Mill(surface, job);
  Random random(4);
  CheckProgram(surface, job, result, random, 2000);
  double nearest = kInfinity;
  for (const Move& move : result.motion.toolpath.moves) {
    if (move.kind != MoveKind::kCut) continue;
    const auto at = ClosestToPoint(surface, move.to, 4.0, 1e-6);
    if (at) nearest = std::min(nearest, at->distance);
  }
  EXPECT_GE(nearest, 2.8 - job.operation.tolerance);
  EXPECT_LE(nearest, 2.8 + job.operation.tolerance);
}

TEST(Strategies, WhatTheFloorLeavesIsReported) {
  Job job = BallJob(2.5);
  job.operation.scallop = 0.02;
  job.operation.floor_z = 2.0;
  const double r = 8.0, radius = 2.5;
  const Surface surface = PlacedSurface(Sphere({0, 0, 0}, r, Half::kUpper));
  const JobResult result = Mill(surface, job);
  Random random(5);
  CheckProgram(surface, job, result, random, 500);
  EXPECT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable);
  // The tip is at (r + R) sin(phi) - R for a contact at latitude phi: zones
  // have the area 2 pi r dz.
  const double lowest = r * (2.0 + radius) / (r + radius), area = 2.0 * kPi * r * lowest;
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kFloor], area, 0.02 * area)
      << Describe(result);
  for (const Move& move : result.motion.toolpath.moves) EXPECT_GE(move.to.z() - radius, 2.0 - 1e-9);
}

TEST(Strategies, ContoursTurnAsAsked) {
  Job job = BallJob(2.0);
  job.operation.scallop = 0.03;
  job.operation.strategy = Strategy::kContour;
  const Surface surface = PlacedSurface(Sphere({0, 0, 0}, 6, Half::kUpper));
  for (const CutDirection direction : {CutDirection::kClimb, CutDirection::kConventional}) {
    job.operation.contour_direction = direction;
    const JobResult result = Mill(surface, job);
    int count = 0;
    for (const CutterPath& path : result.motion.passes) {
      if (path.kind != PassKind::kContour || !path.closed) continue;
      double turn = 0.0;  // twice the area, counter-clockwise positive
      for (std::size_t i = 0; i < path.points.size(); ++i) {
        turn += Cross(Xy(path.points[i].center), Xy(path.points[(i + 1) % path.points.size()].center));
      }
      // Material on the right of a climbing tool: round a hill that is
      // clockwise.
      EXPECT_EQ(turn < 0.0, direction == CutDirection::kClimb);
      ++count;
    }
    EXPECT_GT(count, 5);
  }
}

// A rest pass below a limit, above the highest level, runs along the wall in the direction of the levels.
TEST(Strategies, RestPassesAlongWallsClimbToo) {
  const Surface surface = PlacedSurface(Sphere(Vec3::Zero(), 20, Half::kUpper));
  Job job = BallJob(4.0, false);
  job.operation.scallop = 0.2;
  job.operation.tolerance = 0.05;
  job.operation.leave = 0.05;
  job.operation.steep_angle = Radians(25.0);
  job.operation.strategy = Strategy::kContour;
  job.operation.top_z = 17.46;
  double rest = 0.0;
  for (const CutDirection direction : {CutDirection::kClimb, CutDirection::kConventional}) {
    job.operation.contour_direction = direction;
    const JobResult result = Mill(surface, job);
    ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
    for (const CutterPath& pass : result.motion.passes) {
      const std::size_t moves = pass.points.size() - (pass.closed ? 0 : 1);
      double around = 0.0;  // mm2, twice the area that the way sweeps about the dome's axis
      for (std::size_t i = 0; i < moves; ++i)
        around += Cross(Xy(pass.points[i].center), Xy(pass.points[(i + 1) % pass.points.size()].center));
      if (Length(pass) < 16.0) continue;
      EXPECT_EQ(around < 0.0, direction == CutDirection::kClimb) << pass.points[0].center.transpose();
      if (pass.kind == PassKind::kRest) rest += Length(pass);
    }
  }
  EXPECT_GT(rest, 50.0);
}

}  // namespace
}  // namespace patchmill
