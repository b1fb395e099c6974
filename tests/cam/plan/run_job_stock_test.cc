// Jobs in stock as it lies on the machine: how deep passes cut into it, and what keeps off it.
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "tests/support/jobs/limited_job.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

bool Has(const Diagnostics& findings, std::string_view code) {
  return std::any_of(findings.begin(), findings.end(), [&](const Diagnostic& d) { return d.code == code; });
}

Job JobInBlock(double margin, double top_z) {
  Job job = LimitedJob();
  job.setup.stock_body = BlockStock{margin};
  job.setup.stock_top_z = top_z;
  return job;
}

// A wall of 60 degrees, cut by lines that go down it. With the stock stated, passes may keep their feed; the
// descents onto passes may not.
TEST(JobStock, PassesMayKeepTheirFeedWhereTheyDescend) {
  const double slope = std::tan(Radians(60.0));
  PatchModel model;
  BezierPatch wall;
  wall.degree_u = wall.degree_v = 1;
  wall.points = {{0, 0, 0}, {0, 20, 0}, {8, 0, 8 * slope}, {8, 20, 8 * slope}};
  model.patches.push_back({"", std::move(wall)});
  const Surface surface = PlacedSurface(model);
  Job job = LimitedJob();
  job.operation.strategy = Strategy::kZigzag;
  job.setup.allowance = 0.3;
  job.setup.allowance_stated = true;
  const auto fastest_descent = [](const JobResult& result) {
    double fastest = 0.0;
    const std::vector<Move>& moves = result.motion.toolpath.moves;
    for (std::size_t i = 1; i < moves.size(); ++i) {
      const Vec3 d = moves[i].to - moves[i - 1].to;
      if (moves[i].kind == MoveKind::kCut && -d.z() > 1.01 * std::tan(kDefaultPlungeAngle) * Xy(d).norm())
        fastest = std::max(fastest, moves[i].feed);
    }
    return fastest;
  };
  const JobResult slow = Mill(surface, job);
  ASSERT_EQ(slow.report.outcome, Outcome::kComplete) << Describe(slow);
  EXPECT_EQ(fastest_descent(slow), kTestPlungeFeed);
  job.operation.keep_feed = true;
  const JobResult fast = Mill(surface, job);
  ASSERT_EQ(fast.report.outcome, Outcome::kComplete) << Describe(fast);
  EXPECT_EQ(fastest_descent(fast), kTestFeed);
  job.operation.accept_depth = 0.5;
  EXPECT_FALSE(RunJob(surface, job, RunContext()).ok());
  job.operation.accept_depth = 0.0;
  job.setup.allowance_stated = false;
  const auto refused = RunJob(surface, job, RunContext());
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.status().message().find("feeds.keep_on_passes"), std::string::npos) << refused.status();
}

// The surface lies 3 mm deep in a block from which nothing has been cut.
TEST(JobStock, AWholeBlockNeedsRoughing) {
  const Surface surface = PlacedSurface(Plane(10));
  Job job = JobInBlock(5.0, 3.0);
  const JobResult result = Mill(surface, job);
  EXPECT_EQ(result.report.outcome, Outcome::kNeedsRoughing);
  EXPECT_TRUE(result.program.empty());
  const auto found = std::find_if(result.report.diagnostics.begin(), result.report.diagnostics.end(),
                                  [](const Diagnostic& d) { return d.code == "NEEDS_ROUGHING"; });
  ASSERT_NE(found, result.report.diagnostics.end());
  EXPECT_NE(found->message.find("cut 3 mm deep"), std::string::npos) << found->message;
  job.operation.accept_depth = 2.9;
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kNeedsRoughing);
  job.operation.accept_depth = 3.01;
  const JobResult accepted = Mill(surface, job);
  EXPECT_EQ(accepted.report.outcome, Outcome::kComplete) << Describe(accepted);
  EXPECT_TRUE(Has(accepted.report.diagnostics, "DEPTH_ACCEPTED"));
  EXPECT_NE(accepted.program.find("DEPTH_ACCEPTED"), std::string::npos);
}

TEST(JobStock, NearlyFinishedStockNeedsNoRoughing) {
  const JobResult result = Mill(PlacedSurface(Plane(10)), JobInBlock(5.0, 0.3));
  EXPECT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
}

// Over the surface the block has been cut down to the allowance; beside it stands 2 mm high, where the ball
// reaches when it finishes the border.
TEST(JobStock, ABlockBesideTheSurfaceIsCutNoDeeperThanTheAllowance) {
  const Surface surface = PlacedSurface(Plane(10));
  Job job = JobInBlock(5.0, 2.0);
  job.setup.allowance = 0.3;
  job.setup.allowance_stated = true;
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kNeedsRoughing);
  job.setup.stock_top_z = 0.3;
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kComplete);
  // Where the block ends with the surface nothing stands beside it.
  job.setup.stock_top_z = 2.0;
  job.setup.stock_body = BlockStock{0.0};
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kComplete);
}

// Between two surfaces the stock stands 8 mm high.
TEST(JobStock, RapidsAndLinksKeepOffTheStockBetween) {
  const Surface surface =
      PlacedSurface(Join({Transformed(Plane(5), Eigen::Affine3d(Eigen::Translation3d(-15, 0, 0))),
                          Transformed(Plane(5), Eigen::Affine3d(Eigen::Translation3d(15, 0, 0)))}));
  Job job = LimitedJob();
  job.setup.stock_body = OutlineStock{RingOfBox(-6, -30, 6, 30)};
  job.setup.stock_top_z = 8.0;
  job.setup.allowance_stated = true;
  job.operation.selection.boundary = {RingOfBox(-20, -5, -10, 5), RingOfBox(10, -5, 20, 5)};
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
  int over = 0;
  const std::vector<Move>& moves = result.motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    const Vec3 a = moves[i - 1].to, d = moves[i].to - a;
    for (int k = 0; k <= 200; ++k) {
      const Vec3 c = a + d * k / 200.0;
      const double beside = std::max({std::abs(c.x()) - 6.0, std::abs(c.y()) - 30.0, 0.0});
      const double above = std::max(c.z() - 8.0, 0.0);
      EXPECT_GE(std::hypot(beside, above), kLimitedRadius) << c.transpose();
    }
    over += a.x() * moves[i].to.x() < 0.0 ? 1 : 0;
  }
  EXPECT_GE(over, 1);
}

// Planted faults: a rapid through the block beside the surface, one whose dog-leg does so, a cut into it.
TEST(JobStock, TheVerifierFindsMovesInTheBlock) {
  const Surface surface = PlacedSurface(Plane(10));
  Job job = JobInBlock(10.0, 2.0);
  job.setup.stock_body = OutlineStock{RingOfBox(12, -20, 20, 20)};
  job.setup.allowance_stated = true;
  const RunContext run;
  const Resolved resolved = *Resolve(surface, job, run);
  VerifyParams params = MakeVerifyParams(job, resolved);
  params.finish.scallop.reset();
  const auto findings = [&](const std::string& moves) {
    const std::string text =
        "G21 G17 G90 G40 G49 G94 G54 G61\nT1 M6\nS9000 M3\nG53 G0 Z0\nG0 X0 Y0\nG0 Z6\n" + moves +
        "G53 G0 Z0\nM5\nM9\nM2\n";
    const absl::StatusOr<VerifyReport> report =
        VerifyProgramText(surface, job.operation.tool, text, params, run);
    EXPECT_TRUE(report.ok()) << report.status();
    return report->findings;
  };
  EXPECT_TRUE(findings("G0 X30\n").empty() || !Has(findings("G0 X30\n"), "RAPID_IN_STOCK"));
  EXPECT_TRUE(Has(findings("G0 Z1.5\nG0 X30\nG0 Z6\n"), "RAPID_IN_STOCK"));
  // Straight, this rapid passes the block's corner; one axis after the other, it does not.
  EXPECT_FALSE(Has(findings("G0 X30 Y0\nG0 Z1.5\nG0 X0 Y-100\nG0 Z6\n"), "RAPID_IN_STOCK"));
  EXPECT_TRUE(Has(findings("G0 X30 Y0\nG0 Z1.5\nG0 X0 Y-100\nG0 Z6\n"), "RAPID_DOG_LEG"));
  EXPECT_TRUE(Has(findings("G1 Z1 F300\nG1 X15 F900\nG0 Z6\n"), "CUT_TOO_DEEP"));
  EXPECT_FALSE(Has(findings("G1 Z1.6 F300\nG1 X15 F900\nG0 Z6\n"), "CUT_TOO_DEEP"));
}

ModelStock StockOf(const PatchModel& model) {
  return {std::make_shared<const Surface>(PlacedSurface(model)), "stock"};
}

// A stock with a model of its own: a plate above the surface, by so much as passes would have to cut.
TEST(JobStock, AModelNeedsRoughingWhereItIsThick) {
  const Surface surface = PlacedSurface(Plane(10));
  Job job = LimitedJob();
  job.setup.stock_body = StockOf(Plane(15, 3.0, 0.05, 0.0));  // 2.5 to 3.5 mm over the surface
  const JobResult result = Mill(surface, job);
  EXPECT_EQ(result.report.outcome, Outcome::kNeedsRoughing);
  EXPECT_TRUE(result.program.empty());
  EXPECT_TRUE(Has(result.report.diagnostics, "STOCK_STATED"));
  const double thickest = 3.5 / std::hypot(1.0, 0.05);
  job.operation.accept_depth = thickest - 0.05;
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kNeedsRoughing);
  job.operation.accept_depth = thickest + 0.05;
  const JobResult accepted = Mill(surface, job);
  EXPECT_EQ(accepted.report.outcome, Outcome::kComplete) << Describe(accepted);
  // Nothing is above the top that is given.
  job.operation.accept_depth = 0.0;
  job.setup.stock_top_z = 0.3;
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kComplete);
}

// Two surfaces with a ridge of stock between them, 4 mm high at one end and 12 mm at the other. Rapids over
// the low end are lower than those over the high one, and none touches it.
TEST(JobStock, RapidsAreAsHighAsTheModelNeeds) {
  const Surface surface =
      PlacedSurface(Join({Transformed(Plane(5), Eigen::Affine3d(Eigen::Translation3d(-15, 0, 0))),
                          Transformed(Plane(5), Eigen::Affine3d(Eigen::Translation3d(15, 0, 0)))}));
  const auto highest = [&](double left, double right) {
    Job job = LimitedJob();
    job.setup.stock_body =
        StockOf(Single(Bilinear({-6, -30, left}, {6, -30, left}, {-6, 30, right}, {6, 30, right})));
    job.setup.allowance_stated = true;
    job.operation.selection.boundary = {RingOfBox(-20, -5, -10, 5), RingOfBox(10, -5, 20, 5)};
    const JobResult result = Mill(surface, job);
    EXPECT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
    double over = -kInfinity;
    const std::vector<Move>& moves = result.motion.toolpath.moves;
    for (std::size_t i = 1; i < moves.size(); ++i) {
      const Vec3 a = moves[i - 1].to, d = moves[i].to - a;
      for (int k = 0; k <= 200; ++k) {
        const Vec3 c = a + d * k / 200.0;
        if (std::abs(c.x()) > 6.0 || std::abs(c.y()) > 30.0) continue;
        const double rise = (right - left) / 60.0, top = left + rise * (c.y() + 30.0);
        EXPECT_GE((c.z() - top) / std::hypot(1.0, rise), kLimitedRadius) << c.transpose();
      }
      if (a.x() * moves[i].to.x() < 0.0) over = std::max(over, std::min(a.z(), moves[i].to.z()));
    }
    return over;
  };
  const double low = highest(4.0, 4.0), sloping = highest(4.0, 12.0), high = highest(12.0, 12.0);
  EXPECT_LT(low, 4.0 + kLimitedRadius + 1.0 + 0.2);  // its top, the ball and the approach gap
  EXPECT_GT(sloping, low + 2.0);
  EXPECT_LT(sloping, high - 2.0);
}

// Planted faults: the verifier judges by the model as it does by a block.
TEST(JobStock, TheVerifierFindsMovesInTheModel) {
  const Surface surface = PlacedSurface(Plane(10));
  Job job = LimitedJob();
  job.setup.stock_body = StockOf(Single(Bilinear({12, -20, 1}, {20, -20, 1}, {12, 20, 3}, {20, 20, 3})));
  job.setup.allowance_stated = true;
  const Resolved resolved = *Resolve(surface, job, RunContext());
  EXPECT_NEAR(resolved.stock_top_z, 3.0, 1e-6);
  VerifyParams params = MakeVerifyParams(job, resolved);
  params.finish.scallop.reset();
  const auto findings = [&](const std::string& moves) {
    const std::string text =
        "G21 G17 G90 G40 G49 G94 G54 G61\nT1 M6\nS9000 M3\nG53 G0 Z0\nG0 X0 Y0\nG0 Z6\n" + moves +
        "G53 G0 Z0\nM5\nM9\nM2\n";
    const absl::StatusOr<VerifyReport> report =
        VerifyProgramText(surface, job.operation.tool, text, params, RunContext());
    EXPECT_TRUE(report.ok()) << report.status();
    return report.ok() ? report->findings : Diagnostics();
  };
  // Over its middle the ridge is 2 mm high; at one end 1 mm, at the other 3 mm.
  EXPECT_TRUE(Has(findings("G0 Z1.8\nG0 X30\nG0 Z6\n"), "RAPID_IN_STOCK"));
  EXPECT_FALSE(Has(findings("G0 Z2.2\nG0 X30\nG0 Z6\n"), "RAPID_IN_STOCK"));
  EXPECT_FALSE(Has(findings("G0 Y-19\nG0 Z1.4\nG0 X30\nG0 Z6\n"), "RAPID_IN_STOCK"));
  EXPECT_TRUE(Has(findings("G0 Y19\nG0 Z2.2\nG0 X30\nG0 Z6\n"), "RAPID_IN_STOCK"));
  EXPECT_TRUE(Has(findings("G1 Z1 F300\nG1 X15 F900\nG0 Z6\n"), "CUT_TOO_DEEP"));
  EXPECT_FALSE(Has(findings("G1 Z1.7 F300\nG1 X15 F900\nG0 Z6\n"), "CUT_TOO_DEEP"));
}

TEST(JobStock, TheModelIsMeasuredOnce) {
  const Surface surface = PlacedSurface(Plane(10));
  Job job = LimitedJob();
  job.setup.stock_body = StockOf(Plane(15, 0.3));
  const Resolved first = *Resolve(surface, job, RunContext());
  EXPECT_EQ(Resolve(surface, job, first.stock, RunContext())->stock, first.stock);
  const auto again = RunJob(surface, job, first, RunContext());
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(Mill(surface, job).program, again->program);
}

TEST(JobStock, AModelThatIsMissingIsTold) {
  Job job = LimitedJob();
  job.setup.stock_body = ModelStock{};
  const auto result = RunJob(PlacedSurface(Plane(10)), job, RunContext());
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.status().message().find("setup.stock.model is missing"), std::string::npos)
      << result.status();
}

}  // namespace
}  // namespace patchmill
