// One case for every rule of ValidateJob and of the heights: the message names field, value and constraint.
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/plan/resolve.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's
using ::testing::HasSubstr;

struct BadJob {
  std::string name;
  std::function<void(Job&)> spoil;
  std::vector<std::string> words;  // field, value, constraint
};

void SetRadius(Job& job, double radius) { job.operation.tool.cutter = BallEnd{radius}; }

const double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<BadJob> BadJobs() {
  return {
      {"DiameterZero",
       [](Job& j) { SetRadius(j, 0.0); },
       {"tool.ball_end.diameter_mm", "= 0", "in [0.02, 1000]"}},
      {"DiameterHuge",
       [](Job& j) { SetRadius(j, 501); },
       {"tool.ball_end.diameter_mm", "= 1002", "in [0.02, 1000]"}},
      {"DiameterNan",
       [](Job& j) { SetRadius(j, kNan); },
       {"tool.ball_end.diameter_mm", "nan", "in [0.02, 1000]"}},
      {"SpindleZero",
       [](Job& j) { j.operation.tool.spindle_rpm = 0; },
       {"tool.spindle_rpm", "= 0", "in [1, 1e6]"}},
      {"SpindleFast",
       [](Job& j) { j.operation.tool.spindle_rpm = 2e6; },
       {"tool.spindle_rpm", "= 2e+06", "in [1, 1e6]"}},
      {"FeedZero",
       [](Job& j) { j.operation.tool.feed = 0; },
       {"tool.feed_mm_per_min", "= 0", "in [0.1, 1e6]"}},
      {"FeedNegative",
       [](Job& j) { j.operation.tool.feed = -3; },
       {"tool.feed_mm_per_min", "= -3", "in [0.1, 1e6]"}},
      {"PlungeFeedZero",
       [](Job& j) { j.operation.tool.plunge_feed = 0; },
       {"tool.plunge_feed_mm_per_min", "= 0", "in [0.1, 1e6]"}},
      {"ToolNumber", [](Job& j) { j.operation.tool.number = 0; }, {"tool.number", "= 0", "in [1, 99999]"}},
      {"ToolNumberLarge",
       [](Job& j) { j.operation.tool.number = 100000; },
       {"tool.number", "= 100000", "in [1, 99999]"}},
      {"FluteLength",
       [](Job& j) { j.operation.tool.flute_length = 0; },
       {"tool.flute_length_mm", "= 0", "above 0"}},
      {"ShankDiameter",
       [](Job& j) { j.operation.tool.shank_diameter = -1; },
       {"tool.shank_diameter_mm", "= -1", "above 0"}},
      {"WideShankWithoutFlute",
       [](Job& j) { j.operation.tool.shank_diameter = 8; },
       {"tool.flute_length_mm", "= 8", "required"}},
      {"Stickout", [](Job& j) { j.operation.tool.stickout = 0; }, {"tool.stickout_mm", "= 0", "above 0"}},
      {"ScallopZero",
       [](Job& j) { j.operation.scallop = 0; },
       {"scallop_mm", "= 0", "in (0, ball radius = 3)"}},
      {"ScallopLarge",
       [](Job& j) { j.operation.scallop = 3; },
       {"scallop_mm", "= 3", "in (0, ball radius = 3)"}},
      {"ScallopNan",
       [](Job& j) { j.operation.scallop = kNan; },
       {"scallop_mm", "nan", "in (0, ball radius = 3)"}},
      {"ToleranceSmall",
       [](Job& j) { j.operation.tolerance = 5e-5; },
       {"tolerance_mm", "= 5e-05", "in [0.0001, half the ball radius = 1.5]"}},
      {"ToleranceLarge",
       [](Job& j) { j.operation.tolerance = 1.6; },
       {"tolerance_mm", "= 1.6", "half the ball radius = 1.5"}},
      {"LeaveNegative",
       [](Job& j) { j.operation.leave = -0.1; },
       {"stock_to_leave_mm", "= -0.1", "in [0, 100]"}},
      {"LeaveAboveAllowance",
       [](Job& j) { j.operation.leave = 0.6; },
       {"setup.stock.allowance_mm", "= 0.5", "at least stock_to_leave_mm = 0.6"}},
      {"SteepAngle",
       [](Job& j) { j.operation.steep_angle = Radians(2); },
       {"steep_angle_deg", "= 2", "in [5, 85]"}},
      {"SteepAngleLarge",
       [](Job& j) { j.operation.steep_angle = Radians(90); },
       {"steep_angle_deg", "= 90", "in [5, 85]"}},
      {"ZigzagAngle",
       [](Job& j) { j.operation.zigzag_angle = Radians(400); },
       {"zigzag_angle_deg", "= 400", "in [-360, 360]"}},
      {"ZigzagBend",
       [](Job& j) { j.operation.zigzag_bend = Radians(31); },
       {"zigzag_bend_deg", "= 31", "in [0, 30]"}},
      {"ApproachGap",
       [](Job& j) { j.operation.approach_gap = 0; },
       {"heights.approach_gap_mm", "= 0", "in (0, 100]"}},
      {"ClearanceAboveNegative",
       [](Job& j) { j.operation.clearance_above = -1; },
       {"heights.clearance_above_mm", "= -1", "in (0, 100000]"}},
      {"ClearanceAboveNan",
       [](Job& j) { j.operation.clearance_above = kNan; },
       {"heights.clearance_above_mm", "nan", "in (0, 100000]"}},
      {"Allowance",
       [](Job& j) { j.setup.allowance = -0.5; },
       {"setup.stock.allowance_mm", "= -0.5", "in [0, 100]"}},
      {"ClearanceFar",
       [](Job& j) { j.operation.clearance_z = 1e6; },
       {"heights.clearance_z_mm", "= 1e+06", "in [-100000, 100000]"}},
      {"FloorFar",
       [](Job& j) { j.operation.floor_z = -kInfinity; },
       {"heights.floor_z_mm", "-inf", "in [-100000, 100000]"}},
      {"StockTopFar",
       [](Job& j) { j.setup.stock_top_z = kNan; },
       {"setup.stock.top_z_mm", "nan", "in [-100000, 100000]"}},
      {"ZeroFar",
       [](Job& j) {
         j.setup.zero_point = {1e5, 0, -2e5};
       },
       {"setup.program_zero.z_mm", "= -200000", "in [-100000, 100000]"}},
      {"CoarseDialect",
       [](Job& j) {
         j.dialect = *FindDialect("grbl");
         j.operation.tolerance = 0.002;
       },
       {"tolerance_mm", "= 0.002", "3 decimals of the dialect grbl"}},
      {"CoolantWithoutAWord",
       [](Job& j) {
         j.dialect = *FindDialect("haas");
         j.operation.tool.coolant = Coolant::kAir;
       },
       {"tool.coolant", "haas", "[coolant]"}},
      {"DeviationBesideAWord",
       [](Job& j) { j.control_deviation = 0.001; },
       {"post.control_deviation_mm", "= 0.001", "linuxcnc says itself"}},
      {"DeviationOverItsShare",
       [](Job& j) {
         j.dialect = *FindDialect("fanuc");
         j.operation.tolerance = 0.01;
         j.control_deviation = 0.004;
       },
       {"post.control_deviation_mm", "= 0.004", "(0, 0.003]"}},
      {"WorkOffset", [](Job& j) { j.work_offset = "G60"; }, {"post.work_offset", "\"G60\"", "G54"}},
  };
}

class ValidateJobRules : public ::testing::TestWithParam<BadJob> {};

TEST_P(ValidateJobRules, NameFieldValueAndConstraint) {
  Job job = BallJob(3.0);
  ASSERT_TRUE(ValidateJob(job).ok());
  GetParam().spoil(job);
  const absl::Status status = ValidateJob(job);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  for (const std::string& word : GetParam().words) {
    EXPECT_THAT(std::string(status.message()), HasSubstr(word));
  }
}
INSTANTIATE_TEST_SUITE_P(Rules, ValidateJobRules, ::testing::ValuesIn(BadJobs()),
                         [](const auto& bad) { return bad.param.name; });

// Bad jobs do no work: RunJob and PlanRegions answer the same.
TEST(ValidateJob, IsAskedFirst) {
  const Surface surface = PlacedSurface(Plane(5));
  Job job = BallJob(3.0);
  job.operation.scallop = -1;
  EXPECT_EQ(RunJob(surface, job, RunContext()).status(), ValidateJob(job));
  EXPECT_EQ(PlanRegions(surface, job, RunContext()).status(), ValidateJob(job));
}

TEST(Heights, ContradictionsAreNamed) {
  const Surface surface = PlacedSurface(Plane(5, /*z0=*/2.0));
  Job job = BallJob(3.0);
  job.operation.clearance_z = 2.2;  // model 2, stock 2.5
  absl::Status status = RunJob(surface, job, RunContext()).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("clearance_z_mm = 2.2; must be at least 2.5"));

  job = BallJob(3.0);
  job.setup.stock_top_z = 1.5;
  status = RunJob(surface, job, RunContext()).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()),
              HasSubstr("top_z_mm = 1.5; must be at least the model's top, 2"));
}

TEST(Heights, TheToleranceIsTheWholeBudget) {
  for (const double tolerance : {1e-4, 0.01, 0.3}) {
    const Budget b = SplitBudget(tolerance);
    EXPECT_DOUBLE_EQ(b.chord + b.arc + b.rounding + b.certificate + b.controller, tolerance);
    for (const double share : {b.chord, b.arc, b.rounding, b.certificate, b.controller})
      EXPECT_GT(share, 0.0);
    // What passes may use themselves.
    EXPECT_DOUBLE_EQ(b.chord + b.arc, ReachTolerance(tolerance));
  }
}

// Callers of the library have no wire that looks at outlines before.
TEST(Limits, OutlinesAndMarginsAreChecked) {
  const Ring square = {{0, 0}, {4, 0}, {4, 4}, {0, 4}}, line = {{0, 0}, {4, 4}, {8, 8}};
  const auto message = [&](const std::function<void(Job&)>& spoil) {
    Job job = BallJob(3.0);
    job.operation.selection.boundary = {square};
    job.setup.obstacles.push_back({"vice", square, 5.0, 1.0});
    EXPECT_TRUE(ValidateJob(job).ok());
    spoil(job);
    const absl::Status status = ValidateJob(job);
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    return std::string(status.message());
  };
  EXPECT_THAT(message([&](Job& j) { j.operation.selection.boundary.push_back(line); }),
              HasSubstr("selection.boundary_xy_mm is no outline"));
  EXPECT_THAT(message([&](Job& j) { j.operation.selection.boundary[0][1].x() = kNan; }),
              HasSubstr("selection.boundary_xy_mm is no outline"));
  EXPECT_THAT(message([&](Job& j) { j.operation.selection.boundary_offset = -1001; }),
              HasSubstr("selection.boundary_offset_mm = -1001; must be in [-1000, 1000]"));
  EXPECT_THAT(message([&](Job& j) { j.operation.selection.avoid_margin = -1; }),
              HasSubstr("selection.avoid_margin_mm = -1; must be in [0, 100]"));
  EXPECT_THAT(message([&](Job& j) { j.setup.obstacles[0].outline = line; }),
              HasSubstr("setup.obstacles[0].outline_xy_mm is no outline"));
  EXPECT_THAT(message([&](Job& j) { j.setup.obstacles[0].top_z = kNan; }),
              HasSubstr("setup.obstacles[0].top_z_mm = nan"));
  EXPECT_THAT(message([&](Job& j) { j.setup.obstacles[0].margin = -2; }),
              HasSubstr("setup.obstacles[0].margin_mm = -2; must be in [0, 1000]"));
  EXPECT_THAT(message([&](Job& j) { j.operation.top_z = kInfinity; }), HasSubstr("heights.top_z_mm = inf"));
}

TEST(Placement, BadValuesAreNamed) {
  patchmill::Setup setup;
  setup.placement.scale = 0.0;
  absl::Status status = BuildPlacedSurface(Plane(5), setup, RunContext()).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("setup.scale = 0; must be in (0, 1e9]"));
  setup = {};
  setup.placement.translation = {kNan, 0, 0};
  status = BuildPlacedSurface(Plane(5), setup, RunContext()).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("setup.translation_mm"));
}

}  // namespace
}  // namespace patchmill
