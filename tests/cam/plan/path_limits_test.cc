// Limits stop a job when its passes really come to more, and nothing else does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error_details.h"
#include "core/patch/piece.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's
using ::testing::HasSubstr;

// A hill with lines on its gentle area and contours on its steep area.
PatchModel Hill() { return Paraboloid(-0.05, 14); }

absl::StatusOr<JobResult> RunWith(const Surface& surface, const Job& job, int threads) {
  return RunJob(surface, job, RunContext(threads));
}

void ExpectPassed(const absl::StatusOr<JobResult>& result, const std::string& name, double limit) {
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.status().code(), absl::StatusCode::kResourceExhausted);
  const std::optional<PassedLimit> passed = LimitPassedOf(result.status());
  ASSERT_TRUE(passed.has_value()) << result.status();
  EXPECT_EQ(passed->name, name);
  EXPECT_EQ(passed->limit, limit);
  EXPECT_GT(passed->value, limit);
  EXPECT_THAT(std::string(result.status().message()), HasSubstr("scallop"));
}

TEST(PathLimits, AreThoseOfTheProgram) {
  const Surface surface = PlacedSurface(Hill());
  for (const Strategy strategy : {Strategy::kAuto, Strategy::kContour, Strategy::kZigzag}) {
    Job job = BallJob(3.0);
    job.operation.scallop = 0.05;
    job.operation.strategy = strategy;
    const JobResult free = Mill(surface, job);
    ASSERT_FALSE(free.program.empty());
    const double length = free.report.motion.cut_length + free.report.motion.link_length;
    // Points of the passes, before arcs stand for many of them.
    const auto points = static_cast<double>(free.motion.toolpath.moves.size());

    // Passes are counted as they are made: contours hold more points before they are thinned, and what
    // others finish is taken away later.
    job.path_limits = {1.1 * length, 10.0 * points};
    const JobResult within = Mill(surface, job);
    EXPECT_EQ(within.program, free.program);
    for (const double share : {0.99, 0.3}) {
      job.path_limits = {share * length, kInfinity};
      const absl::StatusOr<JobResult> one = RunWith(surface, job, 1);
      ExpectPassed(one, "cut_length_mm", share * length);
      EXPECT_EQ(RunWith(surface, job, 3).status(), one.status());
      job.path_limits = {kInfinity, share * points};
      const absl::StatusOr<JobResult> other = RunWith(surface, job, 1);
      ExpectPassed(other, "point_count", share * points);
      EXPECT_EQ(RunWith(surface, job, 3).status(), other.status());
    }
  }
}

// The same surface, but for a strip along two sides of each piece: no patch of it is a copy of a whole one.
PatchModel MostOf(const PatchModel& whole, double share) {
  PatchModel most;
  for (const Patch& patch : whole.patches) {
    for (const Piece& piece : SplitIntoPieces(PatchId(0), patch.shape)) {
      const BernsteinNet part = SubNet(piece.net, 0.0, share, 0.0, share);
      BezierPatch bezier{part.degree_u, part.degree_v, {}, {}};
      for (const Vec4& p : part.points) bezier.points.emplace_back(p.head<3>());
      most.patches.push_back({"", std::move(bezier)});
    }
  }
  return most;
}

// The least cut length counts surface twice that lies on other surface in part. Its passes are made once, and
// only they count for the limit.
TEST(PathLimits, AnEstimateRefusesNothing) {
  const Surface once = PlacedSurface(Hill());
  const Surface thrice = PlacedSurface(Join({Hill(), MostOf(Hill(), 0.99), MostOf(Hill(), 0.985)}));
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  const JobResult free = Mill(once, job);
  job.path_limits.length = 1.35 * (free.report.motion.cut_length + free.report.motion.link_length);
  const JobResult result = Mill(thrice, job);
  EXPECT_GT(result.report.least_cut_length, job.path_limits.length);
  EXPECT_FALSE(result.program.empty()) << Describe(result);
}

// What is far above the limit ends before its passes are made.
TEST(PathLimits, FarAboveThemNoPassIsMade) {
  const Surface surface = PlacedSurface(Hill());
  Job job = BallJob(3.0);
  const JobResult free = Mill(surface, job);
  job.path_limits.length = free.report.least_cut_length / 10.1;
  std::string last;
  RunContext run(1);
  run.set_progress([&](std::string_view stage, double) { last = std::string(stage); });
  const absl::StatusOr<JobResult> result = RunJob(surface, job, run);
  ExpectPassed(result, "cut_length_mm", job.path_limits.length);
  EXPECT_THAT(std::string(result.status().message()),
              HasSubstr("that is what the passes of this finish come to"));
  EXPECT_EQ(last.find("zigzag"), std::string::npos) << last;
  EXPECT_EQ(last.find("contours"), std::string::npos) << last;
}

// Two small parts far apart are a large box and a short program.
TEST(PathLimits, WhatLiesInTheBoxButIsNotThereCountsForNothing) {
  const PatchModel far = Transformed(Hill(), Eigen::Affine3d(Eigen::Translation3d(400.0, 400.0, 0.0)));
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  const JobResult alone = Mill(PlacedSurface(Hill()), job);
  const double length = alone.report.motion.cut_length + alone.report.motion.link_length;
  job.path_limits.length = 2.1 * length;
  const JobResult both = Mill(PlacedSurface(Join({Hill(), far})), job);
  EXPECT_FALSE(both.program.empty()) << Describe(both);
}

}  // namespace
}  // namespace patchmill
