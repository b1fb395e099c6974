// Holders: what they keep the ball from in closed form, moves judged by plain geometry.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "cam/plan/resolve.h"
#include "cam/post/program_reader.h"
#include "tests/support/jobs/limited_job.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kBall = 2.0, kHolderRadius = 6.0, kClearance = 0.5;

Job HolderJob(double stickout) {
  Job job = LimitedJob();
  job.operation.tool.cutter = BallEnd{kBall};
  job.operation.tool.stickout = stickout;
  job.operation.tool.holder = {{20.0, 2.0 * kHolderRadius, 2.0 * kHolderRadius}};
  job.operation.tool.holder_clearance = kClearance;
  return job;
}

bool Has(const Diagnostics& findings, const std::string& code) {
  return std::any_of(findings.begin(), findings.end(), [&](const Diagnostic& d) { return d.code == code; });
}

// The verdict on a program that was made for `job`, with the tool of another one.
VerifyReport Judge(const Surface& surface, const Job& job, const std::string& program) {
  const auto resolved = Resolve(surface, job, RunContext());
  EXPECT_TRUE(resolved.ok()) << resolved.status();
  const auto report =
      VerifyProgramText(surface, job.operation.tool, program, MakeVerifyParams(job, *resolved), RunContext());
  EXPECT_TRUE(report.ok()) << report.status();
  return report.value_or(VerifyReport{});
}

constexpr double kHalf = 8.0, kTop = 16.0;

// A block 16 mm high on a plate, a stick-out of 12 mm: beside the block the holder keeps the ball off the
// plate as far as it is wide, and off the wall where its lower end is below the top.
TEST(Holder, KeepsOffABlock) {
  const double stickout = 12.0, wide = kHolderRadius + kClearance;
  const Surface surface = PlacedSurface(Block(kHalf, kTop, 30));
  const JobResult result = Mill(surface, HolderJob(stickout));
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  const double plate = 8.0 * kHalf * (wide - kBall) + kPi * (wide * wide - kBall * kBall);
  const double wall = 8.0 * kHalf * (kTop - (stickout - kClearance - kBall) - kBall);
  const VerifyReport& verify = result.report.verify;
  EXPECT_NEAR(verify.unreachable_area[UncutReason::kHolder], plate + wall, 0.01 * (plate + wall));
  EXPECT_NEAR(AreaFor(result, UnreachableReason::kHolder), plate + wall, 0.01 * (plate + wall));
  EXPECT_EQ(verify.unreachable_area[UncutReason::kShank], 0.0);
  EXPECT_TRUE(verify.holder_ok.value_or(false));
  EXPECT_FALSE(Has(result.report.diagnostics, "HOLDER_NOT_CHECKED"));
  // The tip on the plate, the holder with its clearance over the block.
  ASSERT_TRUE(verify.finishing_stickout);
  const double named = *verify.finishing_stickout;
  EXPECT_GE(named, kTop + kClearance);
  EXPECT_LE(named, kTop + kClearance + 0.0071);
  const JobResult longer = Mill(surface, HolderJob(named));
  ASSERT_EQ(longer.report.outcome, Outcome::kCompleteWhereReachable) << Describe(longer);
  EXPECT_EQ(longer.report.verify.unreachable_area[UncutReason::kHolder], 0.0);
  EXPECT_FALSE(longer.report.verify.finishing_stickout);
}

// With a wide shank below it, each part has what it alone forbids.
TEST(Holder, AboveAWideShank) {
  const Surface surface = PlacedSurface(Block(kHalf, kTop, 30));
  Job job = HolderJob(14.0);
  job.operation.tool.shank_diameter = 8.0;
  job.operation.tool.flute_length = 10.0;
  const JobResult both = Mill(surface, job);
  ASSERT_EQ(both.report.outcome, Outcome::kCompleteWhereReachable) << Describe(both);
  const double shank = 4.0, wide = kHolderRadius + kClearance;
  const double near = 8.0 * kHalf * (shank - kBall) + kPi * (shank * shank - kBall * kBall) +
                      8.0 * kHalf * (kTop - 8.0 - kBall);
  const double far = 8.0 * kHalf * (wide - shank) + kPi * (wide * wide - shank * shank);
  EXPECT_NEAR(both.report.verify.unreachable_area[UncutReason::kShank], near, 0.01 * near);
  EXPECT_NEAR(both.report.verify.unreachable_area[UncutReason::kHolder], far, 0.01 * far);
  EXPECT_NEAR(AreaFor(both, UnreachableReason::kShank), near, 0.01 * near);
  EXPECT_NEAR(AreaFor(both, UnreachableReason::kHolder), far, 0.01 * far);
}

// A program that was planned without the holder drives it into the block.
TEST(Holder, ThatTouchesIsFound) {
  const Surface surface = PlacedSurface(Block(kHalf, kTop, 30));
  Job without = HolderJob(12.0);
  without.operation.tool.holder.clear();
  const JobResult planned = Mill(surface, without);
  ASSERT_FALSE(planned.program.empty()) << Describe(planned);
  EXPECT_FALSE(planned.report.verify.holder_ok.has_value());
  const VerifyReport judged = Judge(surface, HolderJob(12.0), planned.program);
  EXPECT_FALSE(judged.ok());
  EXPECT_TRUE(Has(judged.findings, "HOLDER_GOUGE"));
  EXPECT_FALSE(judged.holder_ok.value_or(true));
  // The ball runs along the foot of the wall: the holder stands in the block by its radius, less the ball's.
  EXPECT_NEAR(judged.max_gouge, std::min(kHolderRadius + kClearance - kBall, kTop - 12.0 + kClearance), 0.02);
}

// A clamp as high as the holder begins keeps off the holder, not the ball. Another one is far away.
TEST(Holder, KeepsOffClamps) {
  const Surface surface = PlacedSurface(Plane(20));
  Job job = HolderJob(10.0);
  job.setup.obstacles.push_back({"", {{-50, -30}, {-40, -30}, {-40, 30}, {-50, 30}}, 12.0, 1.0});
  job.setup.obstacles.push_back({"", {{18, -30}, {30, -30}, {30, 30}, {18, 30}}, 12.0, 1.0});
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  double nearest = kInfinity;
  for (const Move& move : result.motion.toolpath.moves) {
    if (move.to.z() < 5.0) nearest = std::min(nearest, 18.0 - move.to.x());
  }
  EXPECT_NEAR(nearest, kHolderRadius + kClearance + 1.0, 0.02);
  // The clamp itself keeps the ball off a strip along the border, the holder off another one beside it.
  const double clamp = 40.0 * (20.0 - (18.0 - kBall - 1.0));
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kAvoided], clamp, 0.05 * clamp);
  const double strip = 40.0 * (kHolderRadius + kClearance - kBall);
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kHolder], strip, 0.05 * strip);
  EXPECT_NEAR(AreaFor(result, UnreachableReason::kHolder), strip, 0.05 * strip);
  ASSERT_TRUE(result.report.verify.finishing_stickout);
  EXPECT_NEAR(*result.report.verify.finishing_stickout, 12.0 + 1.0 + kClearance, 0.01);
  Job without = job;
  without.operation.tool.holder.clear();
  const JobResult planned = Mill(surface, without);
  const VerifyReport judged = Judge(surface, job, planned.program);
  EXPECT_TRUE(Has(judged.findings, "HOLDER_HIT"));
  EXPECT_FALSE(Has(judged.findings, "OBSTACLE_HIT"));
  for (const Diagnostic& finding : judged.findings) {
    if (finding.code != "HOLDER_HIT") continue;
    EXPECT_NE(finding.message.find("obstacle #1"), std::string::npos) << finding.message;
  }
  EXPECT_FALSE(judged.holder_ok.value_or(true));
}

// The stock beside the part stands 8 mm high, and the holder begins 5 mm above the tip. The ball keeps as far
// off it as the holder is wide. A prism and a model of the same shape do the same.
TEST(Holder, KeepsOffTheStockBesideThePart) {
  const Surface surface = PlacedSurface(Plane(10));
  Job job = HolderJob(5.0);
  job.setup.stock_body = OutlineStock{{{14, -20}, {20, -20}, {20, 20}, {14, 20}}};
  job.setup.stock_top_z = 8.0;
  job.setup.allowance = 0.3;
  job.setup.allowance_stated = true;
  const auto bar = std::make_shared<const Surface>(
      PlacedSurface(Single(Bilinear({14, -20, 8}, {20, -20, 8}, {14, 20, 8}, {20, 20, 8}))));
  Job of_model = job;
  of_model.setup.stock_body = ModelStock{bar, "bar"};
  // The strip that the holder keeps the ball off, beyond the clearance that the stock has anyway.
  const double edge = 14.0 - kHolderRadius - kClearance;
  for (const Job& each : {job, of_model}) {
    const JobResult result = Mill(surface, each);
    ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
    EXPECT_TRUE(result.report.verify.holder_ok.value_or(false));
    double nearest = -kInfinity;
    for (const Move& move : result.motion.toolpath.moves) {
      if (move.to.z() < 4.0) nearest = std::max(nearest, move.to.x());
    }
    EXPECT_LE(nearest, edge);
    EXPECT_GE(nearest, edge - 0.3);
    const double strip = 20.0 * (10.0 - edge);
    EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kHolder], strip, 0.12 * strip);
    EXPECT_NEAR(AreaFor(result, UnreachableReason::kHolder), strip, 0.12 * strip);
    ASSERT_TRUE(result.report.verify.finishing_stickout);
    EXPECT_NEAR(*result.report.verify.finishing_stickout, 8.0 + kClearance, 0.05);
    // A depth that the ball may cut is none for the holder.
    Job deep = each;
    deep.operation.accept_depth = 25.0;
    EXPECT_EQ(Mill(surface, deep).report.outcome, Outcome::kCompleteWhereReachable);
    Job longer = each;
    longer.operation.tool.stickout = 9.0;
    const JobResult whole = Mill(surface, longer);
    EXPECT_EQ(whole.report.outcome, Outcome::kComplete) << Describe(whole);
    // Planted fault: a program that was planned without the holder.
    Job without = each;
    without.operation.tool.holder.clear();
    const JobResult planned = Mill(surface, without);
    ASSERT_FALSE(planned.program.empty()) << Describe(planned);
    const VerifyReport judged = Judge(surface, each, planned.program);
    EXPECT_TRUE(Has(judged.findings, "HOLDER_IN_STOCK"));
    EXPECT_FALSE(judged.holder_ok.value_or(true));
    EXPECT_FALSE(judged.ok());
  }
}

// Low rapids keep the holder off what stands beside their way.
TEST(Holder, RapidsAreHighEnough) {
  const Surface surface = PlacedSurface(Block(kHalf, kTop, 30));
  Job job = HolderJob(8.0);
  job.setup.allowance = 0.3;
  job.setup.allowance_stated = true;
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  EXPECT_TRUE(result.report.verify.holder_ok.value_or(false));
  double deepest = -kInfinity;  // of the block's edges in the holder
  const std::vector<Move>& moves = result.motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    const Vec3 from = moves[i - 1].to, way = moves[i].to - from;
    const int places = 1 + static_cast<int>(way.norm() / 0.5);
    for (int k = 0; k <= places; ++k) {
      const Vec3 c = from + way * (static_cast<double>(k) / places);
      const Vec2 beside = (Xy(c).cwiseAbs().array() - kHalf).max(0.0);
      deepest = std::max(deepest, std::min(kHolderRadius - beside.norm(), kTop - (c.z() - kBall + 8.0)));
    }
  }
  EXPECT_LE(deepest, -kClearance + 0.011);
}

// The allowance may stand on the surface beside the holder.
TEST(Holder, NeedsAsMuchClearanceAsTheAllowance) {
  Job job = HolderJob(12.0);
  job.setup.allowance = kClearance + 0.1;
  const auto result = RunJob(PlacedSurface(Plane(10)), job, RunContext());
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.status().message().find("tool.holder_clearance_mm"), std::string::npos) << result.status();
}

TEST(Holder, NeedsAStickout) {
  Job job = HolderJob(12.0);
  job.operation.tool.stickout.reset();
  const auto result = RunJob(PlacedSurface(Plane(10)), job, RunContext());
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.status().message().find("tool.stickout_mm is missing"), std::string::npos)
      << result.status();
}

}  // namespace
}  // namespace patchmill
