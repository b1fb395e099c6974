// Jobs whose stock stands differently deep on walls and on floors.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/jobs/limited_job.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

bool Has(const Diagnostics& findings, std::string_view code) {
  return std::any_of(findings.begin(), findings.end(), [&](const Diagnostic& d) { return d.code == code; });
}

Job JobWith(double walls, double floors) {
  Job job = LimitedJob();
  job.setup.allowance = {walls, floors};
  job.setup.allowance_stated = true;
  return job;
}

// What the verifier finds in a program of these moves, for the stock of the job.
Diagnostics Judged(const Surface& surface, const Job& job, const std::string& moves) {
  const RunContext run;
  VerifyParams params = MakeVerifyParams(job, *Resolve(surface, job, run));
  params.finish.scallop.reset();
  const std::string text = "G21 G17 G90 G40 G49 G94 G54 G61\nT1 M6\nS9000 M3\nG53 G0 Z0\nG0 X0 Y0\nG0 Z40\n" +
                           moves + "G53 G0 Z0\nM5\nM9\nM2\n";
  const absl::StatusOr<VerifyReport> report =
      VerifyProgramText(surface, job.operation.tool, text, params, run);
  EXPECT_TRUE(report.ok()) << report.status();
  return report.ok() ? report->findings : Diagnostics();
}

// A plane that rises towards x by `slope`, and what is found in a rapid along it, `off` from it.
bool RapidIsInStock(const Job& job, double slope, double off) {
  const Vec3 along(10 * std::cos(slope), 0, 10 * std::sin(slope)), y(0, 10, 0);
  const Surface surface = PlacedSurface(Single(Bilinear(-along - y, along - y, -along + y, along + y)));
  const Vec3 tip =
      (kLimitedRadius + off) * Vec3(-std::sin(slope), 0, std::cos(slope)) - kLimitedRadius * Vec3::UnitZ();
  return Has(
      Judged(surface, job, fmt::format("G0 X{:.4f} Y-5\nG0 Z{:.4f}\nG0 Y5\nG0 Z40\n", tip.x(), tip.z())),
      "RAPID_IN_STOCK");
}

// Planted rapids. That over a floor would be clear of the stock if it were as deep as on walls.
TEST(JobWallAllowance, TheVerifierFindsRapidsAsDeepAsTheSlopeSays) {
  const Job job = JobWith(0.2, 0.5);
  for (const double slope_deg : {0.0, 30.0, 60.0, 85.0}) {
    const double slope = Radians(slope_deg), deep = 0.2 + 0.3 * std::cos(slope);
    EXPECT_TRUE(RapidIsInStock(job, slope, deep - 0.005)) << slope_deg;
    EXPECT_FALSE(RapidIsInStock(job, slope, deep + 0.005)) << slope_deg;
  }
  EXPECT_TRUE(RapidIsInStock(job, 0.0, 0.3));
  EXPECT_FALSE(RapidIsInStock(JobWith(0.2, 0.2), 0.0, 0.3));
}

// With more on walls the larger allowance holds for rapids, whatever the slope.
TEST(JobWallAllowance, RapidsKeepOffTheWallAllowance) {
  const Job job = JobWith(0.5, 0.2);
  EXPECT_TRUE(RapidIsInStock(job, Radians(85.0), 0.495));
  for (const double slope_deg : {0.0, 45.0, 85.0})
    EXPECT_FALSE(RapidIsInStock(job, Radians(slope_deg), 0.505)) << slope_deg;
}

// A block beside the surface, 5 mm high. From above, passes may cut 0.5 mm of it, from the side 0.2 mm. The
// sides of the block are known to 0.03 mm, which counts in favour of the move.
TEST(JobWallAllowance, TheVerifierJudgesCutsByTheirSide) {
  const Surface surface = PlacedSurface(Plane(10));
  Job job = JobWith(0.2, 0.5);
  job.setup.stock_body = OutlineStock{RingOfBox(12, -20, 20, 20)};
  job.setup.stock_top_z = 5.0;
  const auto beside = [&](double depth) {
    return Has(Judged(surface, job, fmt::format("G1 Z0.6 F300\nG1 X{:.4f} F900\nG0 Z40\n", 9.0 + depth)),
               "CUT_TOO_DEEP");
  };
  const auto above = [&](double depth) {
    return Has(
        Judged(surface, job, fmt::format("G0 X16\nG1 Z{:.4f} F300\nG1 Y5 F900\nG0 Z40\n", 5.0 - depth)),
        "CUT_TOO_DEEP");
  };
  EXPECT_FALSE(beside(0.15));
  EXPECT_TRUE(beside(0.25));
  EXPECT_TRUE(beside(0.45));
  EXPECT_FALSE(above(0.45));
  EXPECT_TRUE(above(0.55));
}

// Beside the surface the block stands 0.45 mm higher. The ball cuts it from above as it finishes the border.
TEST(JobWallAllowance, AFloorPassMayCutTheFloorAllowance) {
  const Surface surface = PlacedSurface(Plane(10));
  Job job = JobWith(0.2, 0.5);
  job.setup.stock_body = BlockStock{5.0};
  job.setup.stock_top_z = 0.45;
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
  EXPECT_NE(result.program.find("0.2 mm of material on walls and 0.5 mm on floors"), std::string::npos);
  job.setup.allowance = {0.2, 0.4};
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kNeedsRoughing);
  job.setup.allowance = {0.5, 0.4};
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kNeedsRoughing);
  job.setup.allowance = 0.5;
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kComplete);
}

// Moves from one plane to another, 48 mm away: they are clear of what stands on the floors, and the verifier
// agrees.
TEST(JobWallAllowance, MovesOverAGapAreClearOfFloors) {
  const Surface surface =
      PlacedSurface(Join({Transformed(Plane(6), Eigen::Affine3d(Eigen::Translation3d(-30, 0, 0))),
                          Transformed(Plane(6), Eigen::Affine3d(Eigen::Translation3d(30, 0, 0)))}));
  for (const StockDepth allowance : {StockDepth(0.1, 0.8), StockDepth(0.8, 0.1)}) {
    Job job = JobWith(allowance.walls, allowance.floors);
    const JobResult result = Mill(surface, job);
    ASSERT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
    const std::vector<Move>& moves = result.motion.toolpath.moves;
    int over = 0;
    for (std::size_t i = 1; i < moves.size(); ++i) {
      if (moves[i].kind == MoveKind::kCut || moves[i].to.x() * moves[i - 1].to.x() > 0.0) continue;
      ++over;
      const double gap = std::min(moves[i].to.z(), moves[i - 1].to.z()) - kLimitedRadius;
      EXPECT_GE(gap, allowance.floors);
      EXPECT_LE(gap, allowance.Most() + job.operation.approach_gap + 0.2);
    }
    EXPECT_GE(over, 1);
  }
}

}  // namespace
}  // namespace patchmill
