// One test per way a job can be wrong: code and message.
#include <limits>

#include <gmock/gmock.h>
#include <google/protobuf/util/field_comparator.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "server/convert/job.h"
#include "server/convert/setup.h"
#include "server/digest.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using testing::BumpRequest;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::StatusIs;
using Request = v1::GenerateProgramRequest;

v1::Setup& SetupOf(Request& r) { return *r.mutable_job()->mutable_setup(); }
v1::Stock& StockOf(Request& r) { return *SetupOf(r).mutable_stock(); }
v1::Operation& OperationOf(Request& r) { return *r.mutable_job()->mutable_operations(0); }
v1::Tool& ToolOf(Request& r) { return *OperationOf(r).mutable_tool(); }
v1::Heights& HeightsOf(Request& r) { return *OperationOf(r).mutable_heights(); }

void SetMachine(Request& r) {
  v1::Machine& machine = *SetupOf(r).mutable_machine();
  machine.set_name("mill");
  for (int k = 0; k < 3; ++k) {
    v1::MachineAxis& axis = *machine.add_axes();
    axis.set_travel_min_mm(-150);
    axis.set_travel_max_mm(150 + k);
    axis.set_rapid_mm_per_min(8000);
    axis.set_feed_mm_per_min(4000);
    axis.set_acceleration_mm_per_s2(600 - k);
  }
  machine.set_junction_deviation_mm(0.02);
  machine.set_spindle_min_rpm(100);
  machine.set_spindle_max_rpm(24000);
  machine.mutable_work_zero()->set_x_mm(-40);
  machine.mutable_work_zero()->set_y_mm(12);
  machine.mutable_work_zero()->set_z_mm(-80);
}

absl::Status Convert(const Request& request) {
  FieldErrors errors;
  FromProto(request.job(), request.post(), "job", errors);
  return errors.ToStatus();
}

TEST(Job, ACompleteOneIsAccepted) { EXPECT_TRUE(Convert(BumpRequest()).ok()) << Convert(BumpRequest()); }

struct Wrong {
  const char* name;
  void (*spoil)(Request&);
  const char* message;  // how it starts
  absl::StatusCode code = absl::StatusCode::kInvalidArgument;
};

class WrongJobs : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongJobs, AreRefusedWithFieldValueAndConstraint) {
  Request request = BumpRequest();
  GetParam().spoil(request);
  EXPECT_THAT(Convert(request), StatusIs(GetParam().code, StartsWith(GetParam().message)));
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr auto kNext = absl::StatusCode::kUnimplemented;
const auto kName = [](const auto& wrong) { return std::string(wrong.param.name); };

void AddSegment(Request& r, double length, double lower, double upper) {
  v1::HolderSegment& segment = *ToolOf(r).add_holder();
  segment.set_length_mm(length);
  segment.set_lower_diameter_mm(lower);
  segment.set_upper_diameter_mm(upper);
}

INSTANTIATE_TEST_SUITE_P(
    Operations, WrongJobs,
    ::testing::Values(
        Wrong{"NoOperation", [](Request& r) { r.mutable_job()->clear_operations(); },
              "job.operations is missing"},
        Wrong{"NoTool", [](Request& r) { OperationOf(r).clear_tool(); }, "job.operations[0].tool is missing"},
        Wrong{"ScallopNegative", [](Request& r) { OperationOf(r).set_scallop_mm(-1); },
              "job.operations[0].scallop_mm = -1; must be in (0, ball radius = 3)"},
        Wrong{"ScallopMissing", [](Request& r) { OperationOf(r).clear_scallop_mm(); },
              "job.operations[0].scallop_mm = 0; must be"},
        Wrong{"ScallopAboveRadius", [](Request& r) { OperationOf(r).set_scallop_mm(3.1); },
              "job.operations[0].scallop_mm = 3.1; must be in (0, ball radius = 3)"},
        Wrong{"ScallopNan", [](Request& r) { OperationOf(r).set_scallop_mm(kNan); },
              "job.operations[0].scallop_mm = nan; must be"},
        Wrong{"ToleranceMissing", [](Request& r) { OperationOf(r).clear_tolerance_mm(); },
              "job.operations[0].tolerance_mm = 0; must be in [0.0001, half the ball radius = 1.5]"},
        Wrong{"ToleranceHuge", [](Request& r) { OperationOf(r).set_tolerance_mm(2); },
              "job.operations[0].tolerance_mm = 2; must be"},
        Wrong{"ToleranceInfinite", [](Request& r) { OperationOf(r).set_tolerance_mm(kInf); },
              "job.operations[0].tolerance_mm = inf; must be"},
        Wrong{"LeaveHuge", [](Request& r) { OperationOf(r).set_stock_to_leave_mm(101); },
              "job.operations[0].stock_to_leave_mm = 101; must be in [0, 100]"},
        Wrong{"LeaveAboveAllowance",
              [](Request& r) {
                OperationOf(r).set_stock_to_leave_mm(0.6);
                r.mutable_job()->mutable_setup()->mutable_stock()->set_allowance_mm(0.5);
              },
              "job.setup.stock.allowance_mm = 0.5; must be at least stock_to_leave_mm = 0.6"},
        Wrong{"LeaveAboveFloorAllowance",
              [](Request& r) {
                OperationOf(r).set_stock_to_leave_mm(0.4);
                SetupOf(r).mutable_stock()->set_allowance_mm(0.5);
                SetupOf(r).mutable_stock()->set_floor_allowance_mm(0.3);
              },
              "job.setup.stock.floor_allowance_mm = 0.3; must be at least stock_to_leave_mm = 0.4"},
        Wrong{"LeaveNegative", [](Request& r) { OperationOf(r).set_stock_to_leave_mm(-0.1); },
              "job.operations[0].stock_to_leave_mm is not there yet", kNext},
        Wrong{"SteepAngle", [](Request& r) { OperationOf(r).set_steep_angle_deg(90); },
              "job.operations[0].steep_angle_deg = 90; must be in [5, 85]"},
        Wrong{"SteepAngleNan", [](Request& r) { OperationOf(r).set_steep_angle_deg(kNan); },
              "job.operations[0].steep_angle_deg = nan"},
        Wrong{"ZigzagAngleTwice",
              [](Request& r) {
                OperationOf(r).set_zigzag_angle_deg(30);
                OperationOf(r).set_zigzag_angle_auto(true);
              },
              "job.operations[0].zigzag_angle_auto is set, and so is zigzag_angle_deg; set one of them"},
        Wrong{"ZigzagBend", [](Request& r) { OperationOf(r).set_zigzag_bend_deg(31); },
              "job.operations[0].zigzag_bend_deg = 31; must be in [0, 30]"},
        Wrong{"ZigzagAngle", [](Request& r) { OperationOf(r).set_zigzag_angle_deg(361); },
              "job.operations[0].zigzag_angle_deg = 361; must be in [-360, 360]"},
        Wrong{"DetailNan", [](Request& r) { OperationOf(r).set_detail(kNan); },
              "job.operations[0].detail = nan; must be in [0, 1]"},
        Wrong{"DetailAboveOne", [](Request& r) { OperationOf(r).set_detail(1.01); },
              "job.operations[0].detail = 1.01; must be in [0, 1]"},
        Wrong{"Strategy", [](Request& r) { OperationOf(r).set_strategy(static_cast<v1::Strategy>(77)); },
              "job.operations[0].strategy = 77; this server does not know that value"},
        Wrong{"Direction",
              [](Request& r) { OperationOf(r).set_contour_direction(static_cast<v1::CutDirection>(9)); },
              "job.operations[0].contour_direction = 9"},
        Wrong{"Id", [](Request& r) { OperationOf(r).set_id(std::string(201, 'i')); },
              "job.operations[0].id has 201 bytes"},
        Wrong{"Name", [](Request& r) { r.mutable_job()->set_name(std::string(101, 'n')); },
              "job.name has 101 bytes"},
        Wrong{"ApproachGap", [](Request& r) { HeightsOf(r).set_approach_gap_mm(0); },
              "job.operations[0].heights.approach_gap_mm = 0; must be in (0, 100]"},
        Wrong{"LeadRadius", [](Request& r) { OperationOf(r).mutable_leads()->set_radius_mm(0); },
              "job.operations[0].leads.radius_mm = 0; must be in (0, 1000]"},
        Wrong{"LeadSweep", [](Request& r) { OperationOf(r).mutable_leads()->set_sweep_deg(91); },
              "job.operations[0].leads.sweep_deg = 91; must be in [10, 90]"},
        Wrong{"PlungeAngle", [](Request& r) { OperationOf(r).mutable_feeds()->set_plunge_angle_deg(31); },
              "job.operations[0].feeds.plunge_angle_deg = 31; must be in [1, 30]"},
        Wrong{"LinkFeed", [](Request& r) { OperationOf(r).mutable_feeds()->set_link_mm_per_min(0); },
              "job.operations[0].feeds.link_mm_per_min = 0; must be in [0.1, 1e+06]"},
        Wrong{"LeadFeed", [](Request& r) { OperationOf(r).mutable_feeds()->set_lead_mm_per_min(kNan); },
              "job.operations[0].feeds.lead_mm_per_min = nan"},
        Wrong{"CornerFeed", [](Request& r) { OperationOf(r).mutable_feeds()->set_corner_mm_per_min(0); },
              "job.operations[0].feeds.corner_mm_per_min = 0; must be in [0.1, 1e+06]"},
        Wrong{"AcceptDepth", [](Request& r) { OperationOf(r).set_accept_depth_mm(-1); },
              "job.operations[0].accept_depth_mm = -1; must be in [0, 1000]"},
        Wrong{"MaxUnreached", [](Request& r) { OperationOf(r).set_max_unreached_fraction(-0.1); },
              "job.operations[0].max_unreached_fraction = -0.1; must be in [0, 1]"},
        Wrong{"StockBlock", [](Request& r) { StockOf(r).mutable_block()->set_margin_mm(-1); },
              "job.setup.stock.block.margin_mm = -1; must be in [0, 10000]"},
        Wrong{"StockCylinder", [](Request& r) { StockOf(r).mutable_cylinder()->set_diameter_mm(0); },
              "job.setup.stock.cylinder.diameter_mm = 0; must be in (0, 100000]"},
        Wrong{"StockCylinderCenter",
              [](Request& r) {
                StockOf(r).mutable_cylinder()->set_diameter_mm(10);
                StockOf(r).mutable_cylinder()->add_center_xy_mm(1);
              },
              "job.setup.stock.cylinder.center_xy_mm has 1 numbers; must have 2, x and y"},
        Wrong{"MachineAxes", [](Request& r) { SetupOf(r).mutable_machine()->add_axes(); },
              "job.setup.machine.axes has 1 elements; must have 3, X, Y and Z"},
        Wrong{"MachineTravel",
              [](Request& r) {
                SetMachine(r);
                SetupOf(r).mutable_machine()->mutable_axes(1)->set_travel_max_mm(-200);
              },
              "job.setup.machine.axes[1].travel_max_mm = -200; must be above travel_min_mm = -150"},
        Wrong{"MachineAcceleration",
              [](Request& r) {
                SetMachine(r);
                SetupOf(r).mutable_machine()->mutable_axes(2)->set_acceleration_mm_per_s2(0);
              },
              "job.setup.machine.axes[2].acceleration_mm_per_s2 = 0; must be in [0.1, 1e+06]"},
        Wrong{"MachineSpindle",
              [](Request& r) {
                SetMachine(r);
                ToolOf(r).set_spindle_rpm(30000);
              },
              "job.operations[0].tool.spindle_rpm = 30000; must be in the range of the machine, [100, 24000]"},
        Wrong{"StockOutline", [](Request& r) { StockOf(r).mutable_outline()->add_outline_xy_mm(1); },
              "job.setup.stock.outline.outline_xy_mm has 1 numbers; must be packed x y"},
        Wrong{"ClearanceNan", [](Request& r) { HeightsOf(r).set_clearance_z_mm(kNan); },
              "job.operations[0].heights.clearance_z_mm = nan"},
        Wrong{"ClearanceAboveZero", [](Request& r) { HeightsOf(r).set_clearance_above_mm(0); },
              "job.operations[0].heights.clearance_above_mm = 0; must be in (0, 10000]"},
        Wrong{"ClearanceTwice",
              [](Request& r) {
                HeightsOf(r).set_clearance_above_mm(5);
                HeightsOf(r).set_clearance_z_mm(50);
              },
              "job.operations[0].heights.clearance_above_mm is set together with clearance_z_mm"},
        Wrong{"Floor", [](Request& r) { HeightsOf(r).set_floor_z_mm(1e9); },
              "job.operations[0].heights.floor_z_mm = 1000000000; must be in"}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Tools, WrongJobs,
    ::testing::Values(
        Wrong{"NoCutter", [](Request& r) { ToolOf(r).clear_cutter(); },
              "job.operations[0].tool.ball_end is missing"},
        Wrong{"DiameterZero", [](Request& r) { ToolOf(r).mutable_ball_end()->set_diameter_mm(0); },
              "job.operations[0].tool.ball_end.diameter_mm = 0; must be in [0.02, 1000]"},
        Wrong{"DiameterNegative", [](Request& r) { ToolOf(r).mutable_ball_end()->set_diameter_mm(-6); },
              "job.operations[0].tool.ball_end.diameter_mm = -6"},
        Wrong{"DiameterAbsurd", [](Request& r) { ToolOf(r).mutable_ball_end()->set_diameter_mm(1e6); },
              "job.operations[0].tool.ball_end.diameter_mm = 1000000; must be in [0.02, 1000]"},
        Wrong{"NumberMissing", [](Request& r) { ToolOf(r).clear_number(); },
              "job.operations[0].tool.number = 0; must be in [1, 99999]"},
        Wrong{"SpindleMissing", [](Request& r) { ToolOf(r).clear_spindle_rpm(); },
              "job.operations[0].tool.spindle_rpm = 0; must be in [1, 1e+06]"},
        Wrong{"FeedNegative", [](Request& r) { ToolOf(r).set_feed_mm_per_min(-5); },
              "job.operations[0].tool.feed_mm_per_min = -5; must be"},
        Wrong{"PlungeMissing", [](Request& r) { ToolOf(r).clear_plunge_feed_mm_per_min(); },
              "job.operations[0].tool.plunge_feed_mm_per_min = 0; must be"},
        Wrong{"Flute", [](Request& r) { ToolOf(r).set_flute_length_mm(0); },
              "job.operations[0].tool.flute_length_mm = 0; must be"},
        Wrong{"ShankWithoutFlute", [](Request& r) { ToolOf(r).set_shank_diameter_mm(8); },
              "job.operations[0].tool.flute_length_mm is missing; required when shank_diameter_mm = 8"},
        Wrong{"Stickout", [](Request& r) { ToolOf(r).set_stickout_mm(kInf); },
              "job.operations[0].tool.stickout_mm = inf"},
        Wrong{"Holder",
              [](Request& r) {
                ToolOf(r).set_stickout_mm(30);
                AddSegment(r, 20, 40, 0);
              },
              "job.operations[0].tool.holder[0].upper_diameter_mm = 0; must be in (0, 100000]"},
        Wrong{"HolderWithoutStickout", [](Request& r) { AddSegment(r, 20, 40, 40); },
              "job.operations[0].tool.stickout_mm is missing; required with a holder"},
        Wrong{"HolderTooLong",
              [](Request& r) {
                ToolOf(r).set_stickout_mm(30);
                for (int k = 0; k < 101; ++k) AddSegment(r, 20, 40, 40);
              },
              "job.operations[0].tool.holder has 101 segments; must be at most 100"},
        Wrong{"HolderClearance", [](Request& r) { ToolOf(r).set_holder_clearance_mm(-1); },
              "job.operations[0].tool.holder_clearance_mm = -1; must be in [0, 100]"},
        Wrong{"Coolant", [](Request& r) { ToolOf(r).set_coolant(static_cast<v1::Coolant>(50)); },
              "job.operations[0].tool.coolant = 50"},
        Wrong{"ToolName", [](Request& r) { ToolOf(r).set_name(std::string(101, 'n')); },
              "job.operations[0].tool.name has 101 bytes"}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Setups, WrongJobs,
    ::testing::Values(
        Wrong{"ScaleZero", [](Request& r) { SetupOf(r).set_scale(0); },
              "job.setup.scale = 0; must be in [1e-06, 1e+06]"},
        Wrong{"ScaleNegative", [](Request& r) { SetupOf(r).set_scale(-2); }, "job.setup.scale = -2"},
        Wrong{"ScaleNan", [](Request& r) { SetupOf(r).set_scale(kNan); }, "job.setup.scale = nan"},
        Wrong{"Up", [](Request& r) { SetupOf(r).set_up(static_cast<v1::UpAxis>(12)); }, "job.setup.up = 12"},
        Wrong{"Anchor", [](Request& r) { SetupOf(r).set_zero_anchor(static_cast<v1::ZeroAnchor>(9)); },
              "job.setup.zero_anchor = 9"},
        Wrong{"ZeroNan", [](Request& r) { SetupOf(r).mutable_program_zero()->set_y_mm(kNan); },
              "job.setup.program_zero.y_mm = nan"},
        Wrong{"Translation", [](Request& r) { SetupOf(r).mutable_translation()->set_z_mm(1e7); },
              "job.setup.translation.z_mm = 10000000; must be in [-100000, 100000]"},
        Wrong{"WallSide", [](Request& r) { SetupOf(r).add_wall_sides()->mutable_air(); },
              "job.setup.wall_sides[0].patch_id is missing; required"},
        Wrong{"WallSideWithoutPoint", [](Request& r) { SetupOf(r).add_wall_sides()->set_patch_id("w"); },
              "job.setup.wall_sides[0].air is missing; required"},
        Wrong{"StockTop", [](Request& r) { SetupOf(r).mutable_stock()->set_top_z_mm(kNan); },
              "job.setup.stock.top_z_mm = nan"},
        Wrong{"Allowance", [](Request& r) { SetupOf(r).mutable_stock()->set_allowance_mm(-1); },
              "job.setup.stock.allowance_mm = -1; must be in [0, 100]"},
        Wrong{"WallAllowance",
              [](Request& r) {
                SetupOf(r).mutable_stock()->set_allowance_mm(0.5);
                SetupOf(r).mutable_stock()->set_wall_allowance_mm(kNan);
              },
              "job.setup.stock.wall_allowance_mm = nan; must be in [0, 100]"},
        Wrong{"WallAllowanceAlone",
              [](Request& r) { SetupOf(r).mutable_stock()->set_wall_allowance_mm(0.2); },
              "job.setup.stock.floor_allowance_mm is missing; required with wall_allowance_mm"}),
    kName);

constexpr std::string_view kOwnPost =
    "[control]\nname = own\ncomment = ( )\ncomment_length = 80\n[path]\nfollows = exactly\n"
    "[begin]\nG17 G21 G90 G94\nG0 X{x} Y{y}\nZ{z}\n[end]\nM2\n";

INSTANTIATE_TEST_SUITE_P(
    Posts, WrongJobs,
    ::testing::Values(
        Wrong{"Dialect", [](Request& r) { r.mutable_post()->set_dialect("klingon"); },
              "post.dialect = \"klingon\"; must be one of: fanuc, grbl, haas, heidenhain, "
              "linuxcnc, mach3, siemens"},
        Wrong{"PostFile", [](Request& r) { r.mutable_post()->set_post_file("[control]\nname = A b\n"); },
              "post.post_file line 2: name: = \"A b\"; must consist of a-z, 0-9, - and _"},
        Wrong{"ProgramNumber", [](Request& r) { r.mutable_post()->set_program_number(10000); },
              "post.program_number = 10000; must be in [1, 9999]"},
        Wrong{"LineNumbers", [](Request& r) { r.mutable_post()->set_line_number_step(1001); },
              "post.line_number_step = 1001; must be in [0, 1000]"},
        Wrong{"Metres", [](Request& r) { r.mutable_post()->set_unit(v1::LENGTH_UNIT_METER); },
              "post.unit = 3; must be millimetres or inches"},
        Wrong{"InchesThatThePostHasNot",
              [](Request& r) {
                r.mutable_post()->set_post_file(std::string(kOwnPost));
                r.mutable_post()->set_unit(v1::LENGTH_UNIT_INCH);
              },
              "post.unit = inches; the dialect own has none: its file needs unit_mm, unit_inch and {unit}"},
        Wrong{"RestartPoints",
              [](Request& r) {
                r.mutable_post()->set_post_file(std::string(kOwnPost));
                r.mutable_post()->set_restart_points(true);
              },
              "post.restart_points = true; the dialect own has no section [restart]"},
        Wrong{"Deviation", [](Request& r) { r.mutable_post()->set_control_deviation_mm(2.0); },
              "post.control_deviation_mm = 2; must be in (0, 1]"},
        Wrong{"WorkOffset", [](Request& r) { r.mutable_post()->set_work_offset("G60"); },
              "post.work_offset = \"G60\"; must be one of G54 to G59"}),
    kName);

void AddRing(std::initializer_list<double> xy, google::protobuf::RepeatedField<double>* out) {
  for (const double x : xy) out->Add(x);
}

v1::Selection& SelectionOf(Request& r) { return *OperationOf(r).mutable_selection(); }

INSTANTIATE_TEST_SUITE_P(
    Limits, WrongJobs,
    ::testing::Values(
        Wrong{
            "ObstacleWithoutOutline", [](Request& r) { SetupOf(r).add_obstacles(); },
            "job.setup.obstacles[0].outline_xy_mm is no outline: ring 0 has 0 points; must have at least 3"},
        Wrong{"ObstacleOddNumbers",
              [](Request& r) {
                AddRing({0, 0, 1}, SetupOf(r).add_obstacles()->mutable_outline_xy_mm());
              },
              "job.setup.obstacles[0].outline_xy_mm has 3 numbers; must be packed x y"},
        Wrong{"ObstacleFlat",
              [](Request& r) {
                AddRing({0, 0, 1, 1, 2, 2}, SetupOf(r).add_obstacles()->mutable_outline_xy_mm());
              },
              "job.setup.obstacles[0].outline_xy_mm is no outline: ring 0 has all its points on one line"},
        Wrong{"ObstacleMargin",
              [](Request& r) {
                v1::Obstacle& o = *SetupOf(r).add_obstacles();
                AddRing({0, 0, 1, 0, 0, 1}, o.mutable_outline_xy_mm());
                o.set_margin_mm(-1);
              },
              "job.setup.obstacles[0].margin_mm = -1; must be in [0, 1000]"},
        Wrong{"ObstacleTop",
              [](Request& r) {
                v1::Obstacle& o = *SetupOf(r).add_obstacles();
                AddRing({0, 0, 1, 0, 0, 1}, o.mutable_outline_xy_mm());
                o.set_top_z_mm(kNan);
              },
              "job.setup.obstacles[0].top_z_mm = nan; must be in [-100000, 100000]"},
        Wrong{"TooManyObstacles",
              [](Request& r) {
                for (int i = 0; i <= 1000; ++i) SetupOf(r).add_obstacles();
              },
              "job.setup.obstacles has 1001 elements; must have at most 1000"},
        Wrong{"BoundaryNan",
              [](Request& r) {
                AddRing({0, 0, 1, kNan, 0, 1}, SelectionOf(r).mutable_boundary_xy_mm());
              },
              "job.operations[0].selection.boundary_xy_mm[3] = nan; must be in [-100000, 100000]"},
        Wrong{
            "BoundaryTooLong",
            [](Request& r) {
              for (int i = 0; i < 20'001; ++i)
                AddRing({1.0 * i, 0.5 * i * i}, SelectionOf(r).mutable_boundary_xy_mm());
            },
            "job.operations[0].selection.boundary_xy_mm brings the outlines to 20001 points; must be at most "
            "20000"},
        Wrong{"SecondRing",
              [](Request& r) {
                AddRing({0, 0, 1, 0, 0, 1}, SelectionOf(r).mutable_boundary_xy_mm());
                SelectionOf(r).add_more_boundary_rings();
              },
              "job.operations[0].selection.more_boundary_rings[0].xy_mm is no outline"},
        Wrong{"BoundaryMode",
              [](Request& r) { SelectionOf(r).set_boundary_mode(static_cast<v1::BoundaryMode>(9)); },
              "job.operations[0].selection.boundary_mode"},
        Wrong{"BoundaryOffset", [](Request& r) { SelectionOf(r).set_boundary_offset_mm(kInf); },
              "job.operations[0].selection.boundary_offset_mm = inf; must be in [-1000, 1000]"},
        Wrong{"AvoidMargin", [](Request& r) { SelectionOf(r).set_avoid_margin_mm(-0.1); },
              "job.operations[0].selection.avoid_margin_mm = -0.1; must be in [0, 100]"},
        Wrong{"LongPatchId", [](Request& r) { SelectionOf(r).add_patch_ids(std::string(201, 'x')); },
              "job.operations[0].selection.patch_ids[0] has 201 bytes; must have at most 200"},
        Wrong{"TopZ", [](Request& r) { HeightsOf(r).set_top_z_mm(kNan); },
              "job.operations[0].heights.top_z_mm = nan"}),
    kName);

v1::RegionOverride& AddOverride(Request& r, bool by_point) {
  v1::RegionOverride& change = *OperationOf(r).add_region_overrides();
  if (by_point) change.mutable_at();
  return change;
}

INSTANTIATE_TEST_SUITE_P(
    Regions, WrongJobs,
    ::testing::Values(
        Wrong{
            "HashMissing", [](Request& r) { AddOverride(r, false); },
            "job.operations[0].regions_sha256 is missing; required when region_overrides name regions by id"},
        Wrong{"HashShort", [](Request& r) { OperationOf(r).set_regions_sha256("x"); },
              "job.operations[0].regions_sha256 has 1 bytes; must have 32"},
        Wrong{"NegativeId", [](Request& r) { AddOverride(r, false).set_region_id(-1); },
              "job.operations[0].region_overrides[0].region_id = -1; must be at least 0"},
        Wrong{"IdAndPoint", [](Request& r) { AddOverride(r, true).set_region_id(2); },
              "job.operations[0].region_overrides[0].region_id is set together with at"},
        Wrong{"PointNan", [](Request& r) { AddOverride(r, true).mutable_at()->set_y_mm(kNan); },
              "job.operations[0].region_overrides[0].at.y_mm = nan; must be in"},
        Wrong{"OverrideScallop", [](Request& r) { AddOverride(r, true).set_scallop_mm(3); },
              "job.operations[0].region_overrides[0].scallop_mm = 3; must be in (0, ball radius = 3)"},
        Wrong{"OverrideAngle", [](Request& r) { AddOverride(r, true).set_zigzag_angle_deg(400); },
              "job.operations[0].region_overrides[0].zigzag_angle_deg = 400; must be in [-360, 360]"},
        Wrong{"OverrideStrategy",
              [](Request& r) { AddOverride(r, true).set_strategy(static_cast<v1::Strategy>(77)); },
              "job.operations[0].region_overrides[0].strategy = 77"},
        Wrong{"SkippedAndCut",
              [](Request& r) {
                AddOverride(r, true).set_skip(true);
                OperationOf(r).mutable_region_overrides(0)->set_scallop_mm(0.1);
              },
              "job.operations[0].region_overrides[0].skip is set together with how to cut the region"},
        Wrong{"TooMany",
              [](Request& r) {
                for (int i = 0; i < 1001; ++i) AddOverride(r, true);
              },
              "job.operations[0].region_overrides has 1001 elements; must have at most 1000"}),
    kName);

// Places that are only reserved: refused by name, never silently ignored.
INSTANTIATE_TEST_SUITE_P(
    Next, WrongJobs,
    ::testing::Values(Wrong{"SecondOperation",
                            [](Request& r) { *r.mutable_job()->add_operations() = OperationOf(r); },
                            "job.operations[1] is not there yet", kNext},
                      Wrong{"Dwell", [](Request& r) { r.mutable_post()->set_spindle_dwell_s(2); },
                            "post.spindle_dwell_s is not there yet", kNext}),
    kName);

TEST(Job, AllErrorsAreCounted) {
  Request request = BumpRequest();
  OperationOf(request).set_scallop_mm(-1);
  ToolOf(request).set_spindle_rpm(kNan);
  SetupOf(request).set_scale(0);
  EXPECT_THAT(Convert(request), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("(and 2 more)")));
}

// Every field set to something that is not its default.
Request Unusual() {
  Request r = BumpRequest();
  SetupOf(r).set_up(v1::UP_AXIS_NEG_Y);
  SetupOf(r).set_scale(2.5);
  SetupOf(r).set_zero_anchor(v1::ZERO_ANCHOR_BOTTOM_CORNER);
  SetupOf(r).mutable_translation()->set_x_mm(1);
  SetupOf(r).mutable_translation()->set_y_mm(-2);
  SetupOf(r).mutable_translation()->set_z_mm(3);
  SetupOf(r).mutable_stock()->set_top_z_mm(40);
  SetupOf(r).mutable_stock()->set_wall_allowance_mm(0.75);
  SetupOf(r).mutable_stock()->set_floor_allowance_mm(1.0);
  SetupOf(r).mutable_stock()->mutable_block()->set_margin_mm(12);
  SetMachine(r);
  SetupOf(r).add_wall_sides()->set_patch_id("wall");
  SetupOf(r).mutable_wall_sides(0)->mutable_air()->set_y_mm(-4);
  v1::Tool& tool = ToolOf(r);
  tool.set_number(7);
  tool.set_name("ball 6");
  tool.set_flute_length_mm(12);
  tool.set_shank_diameter_mm(8);
  tool.set_stickout_mm(40);
  AddSegment(r, 20, 40, 42);
  AddSegment(r, 5, 63, 63);
  tool.set_holder_clearance_mm(1.25);
  tool.set_coolant(v1::COOLANT_MIST);
  tool.set_cutting_data_is_default(true);
  tool.set_number_is_default(true);
  v1::Operation& op = OperationOf(r);
  op.set_stock_to_leave_mm(0.125);
  op.set_steep_angle_deg(60);
  op.set_strategy(v1::STRATEGY_CONTOUR);
  op.set_zigzag_angle_deg(90);
  op.set_detail(0.25);
  op.set_contour_direction(v1::CUT_DIRECTION_EITHER);
  op.set_contour_spirals(true);
  op.set_border_passes(false);
  op.set_round_lines(false);
  op.set_zigzag_angle_auto(false);
  op.set_zigzag_bend_deg(12.5);
  op.set_edge_rule(v1::EDGE_RULE_ROLL);
  op.mutable_heights()->set_clearance_z_mm(70);
  op.mutable_heights()->set_approach_gap_mm(2);
  op.mutable_heights()->set_high_rapids(true);
  op.mutable_leads()->set_radius_mm(2.25);
  op.mutable_leads()->set_sweep_deg(60);
  op.mutable_feeds()->set_plunge_angle_deg(20);
  op.mutable_feeds()->set_link_mm_per_min(2000);
  op.mutable_feeds()->set_keep_on_passes(true);
  op.mutable_feeds()->set_lead_mm_per_min(600);
  op.mutable_feeds()->set_corner_mm_per_min(450);
  op.set_accept_depth_mm(1.5);
  op.set_max_unreached_fraction(0.75);
  op.mutable_heights()->set_floor_z_mm(-3);
  op.mutable_heights()->set_top_z_mm(30);
  v1::Obstacle& obstacle = *SetupOf(r).add_obstacles();
  obstacle.set_id("vice");
  AddRing({0, 0, 1, 0, 0, 1}, obstacle.mutable_outline_xy_mm());
  obstacle.set_top_z_mm(5);
  obstacle.set_margin_mm(0.5);
  v1::Selection& selection = SelectionOf(r);
  selection.add_patch_ids("bump");
  selection.add_avoid_patch_ids("#0");
  selection.set_avoid_margin_mm(0.25);
  AddRing({0, 0, 9, 0, 0, 9}, selection.mutable_boundary_xy_mm());
  selection.set_boundary_mode(v1::BOUNDARY_MODE_INSIDE);
  selection.set_boundary_offset_mm(-0.125);
  AddRing({1, 1, 2, 1, 1, 2}, selection.add_more_boundary_rings()->mutable_xy_mm());
  op.set_regions_sha256(std::string(32, '\x5a'));
  v1::RegionOverride& skipped = *op.add_region_overrides();
  skipped.set_region_id(3);
  skipped.set_skip(true);
  v1::RegionOverride& own = *op.add_region_overrides();
  own.mutable_at()->set_z_mm(1.5);
  own.set_strategy(v1::STRATEGY_ZIGZAG);
  own.set_zigzag_angle_deg(30);
  own.set_scallop_mm(0.125);
  v1::RegionOverride& open = *op.add_region_overrides();
  open.mutable_at()->set_x_mm(2.5);
  open.set_one_way_lines(false);
  op.set_one_way_lines(true);
  r.mutable_post()->set_dialect("fanuc");
  r.mutable_post()->set_program_number(42);
  r.mutable_post()->set_control_deviation_mm(0.002);
  r.mutable_post()->set_arcs(false);
  r.mutable_post()->set_restart_points(true);
  r.mutable_post()->set_line_number_step(5);
  r.mutable_post()->set_unit(v1::LENGTH_UNIT_INCH);
  r.mutable_post()->set_work_offset("G57");
  return r;
}

TEST(JobRoundTrip, EveryFieldComesBack) {
  const Request request = Unusual();
  FieldErrors errors;
  const Job job = FromProto(request.job(), request.post(), "job", errors);
  ASSERT_TRUE(errors.empty()) << errors.ToStatus();
  v1::Job back = ToProto(job, "0123", "");
  back.clear_source();
  v1::Job expected = request.job();
  expected.clear_source();
  std::string difference;
  google::protobuf::util::MessageDifferencer differencer;
  google::protobuf::util::DefaultFieldComparator degrees;  // there and back through radians
  degrees.set_float_comparison(google::protobuf::util::DefaultFieldComparator::APPROXIMATE);
  degrees.SetDefaultFractionAndMargin(1e-14, 0.0);
  differencer.set_field_comparator(&degrees);
  differencer.ReportDifferencesToString(&difference);
  EXPECT_TRUE(differencer.Compare(back, expected)) << difference;
  EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(PostToProto(job), request.post()));

  v1::Post own = request.post();
  own.set_dialect("shop");
  own.set_post_file(FindDialect("fanuc")->text + "# ours\n");
  own.mutable_post_file()->replace(own.post_file().find("name = fanuc"), 12, "name = shop");
  const Job with_own = FromProto(request.job(), own, "job", errors);
  ASSERT_TRUE(errors.empty()) << errors.ToStatus();
  EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(PostToProto(with_own), own));
}

// The digest covers resolved values: a default that is stated explicitly does not change it, any other value
// does.
TEST(JobDigestTest, SeesEveryFieldAndNoDefault) {
  const auto digest = [](const Request& r) {
    FieldErrors errors;
    return JobDigest(FromProto(r.job(), r.post(), "job", errors), "model", r.job().name());
  };
  const std::string base = digest(BumpRequest());
  Request aloud = BumpRequest();
  SetupOf(aloud).set_up(v1::UP_AXIS_Z);
  SetupOf(aloud).set_scale(1.0);
  OperationOf(aloud).set_steep_angle_deg(45);
  OperationOf(aloud).set_detail(0.5);
  aloud.mutable_post()->set_dialect("linuxcnc");
  aloud.mutable_post()->set_arcs(true);
  EXPECT_EQ(digest(aloud), base);

  const Request unusual = Unusual();
  const auto differs = [&](auto change) {
    Request r = BumpRequest();
    change(r);
    return digest(r) != base;
  };
  EXPECT_TRUE(differs([&](Request& r) { SetupOf(r) = unusual.job().setup(); }));
  EXPECT_TRUE(differs([](Request& r) { SetupOf(r).set_zero_anchor(v1::ZERO_ANCHOR_TOP_CENTER); }));
  EXPECT_TRUE(differs([](Request& r) { SetupOf(r).mutable_stock()->set_top_z_mm(9); }));
  EXPECT_TRUE(differs([](Request& r) { ToolOf(r).set_flute_length_mm(9); }));
  EXPECT_TRUE(differs([](Request& r) { ToolOf(r).set_coolant(v1::COOLANT_AIR); }));
  EXPECT_TRUE(differs([](Request& r) { ToolOf(r).set_cutting_data_is_default(true); }));
  EXPECT_TRUE(differs([](Request& r) { ToolOf(r).set_number_is_default(true); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_strategy(v1::STRATEGY_ZIGZAG); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_contour_direction(v1::CUT_DIRECTION_EITHER); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_detail(0.0); }));
  EXPECT_TRUE(differs([](Request& r) { HeightsOf(r).set_floor_z_mm(-2); }));
  EXPECT_TRUE(differs([](Request& r) { HeightsOf(r).set_top_z_mm(2); }));
  EXPECT_TRUE(differs([](Request& r) { HeightsOf(r).set_high_rapids(true); }));
  EXPECT_TRUE(differs([](Request& r) { SetMachine(r); }));
  EXPECT_TRUE(differs([](Request& r) { SetupOf(r).add_wall_sides()->mutable_air(); }));
  EXPECT_TRUE(differs([](Request& r) { StockOf(r).mutable_block(); }));
  EXPECT_TRUE(differs([](Request& r) { StockOf(r).mutable_cylinder()->set_diameter_mm(90); }));
  EXPECT_TRUE(differs([](Request& r) {
    AddRing({0, 0, 9, 0, 0, 9}, StockOf(r).mutable_outline()->mutable_outline_xy_mm());
  }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).mutable_leads()->set_radius_mm(2); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).mutable_leads()->set_sweep_deg(80); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).mutable_feeds()->set_plunge_angle_deg(20); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).mutable_feeds()->set_link_mm_per_min(900); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).mutable_feeds()->set_keep_on_passes(true); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).mutable_feeds()->set_lead_mm_per_min(900); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).mutable_feeds()->set_corner_mm_per_min(300); }));
  EXPECT_TRUE(differs([](Request& r) { *StockOf(r).mutable_model() = r.job().source(); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_accept_depth_mm(1); }));
  EXPECT_TRUE(differs([](Request& r) {
    ToolOf(r).set_stickout_mm(40);
    AddSegment(r, 20, 40, 40);
  }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_max_unreached_fraction(0.75); }));
  EXPECT_TRUE(differs([](Request& r) { SelectionOf(r).add_patch_ids("bump"); }));
  EXPECT_TRUE(differs([](Request& r) { r.mutable_post()->set_arcs(false); }));
  EXPECT_TRUE(differs([](Request& r) { r.mutable_post()->set_restart_points(true); }));
  EXPECT_TRUE(differs([](Request& r) { r.mutable_post()->set_line_number_step(7); }));
  EXPECT_TRUE(differs([](Request& r) { r.mutable_post()->set_unit(v1::LENGTH_UNIT_INCH); }));
  EXPECT_TRUE(differs([](Request& r) { SelectionOf(r).add_avoid_patch_ids("bump"); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_regions_sha256(std::string(32, 'x')); }));
  EXPECT_TRUE(differs([](Request& r) { AddOverride(r, true).set_skip(true); }));
  EXPECT_TRUE(differs([](Request& r) { AddOverride(r, true).set_scallop_mm(0.125); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_one_way_lines(true); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_contour_spirals(true); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_border_passes(false); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_round_lines(false); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_zigzag_angle_auto(true); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_zigzag_bend_deg(0); }));
  EXPECT_TRUE(differs([](Request& r) { OperationOf(r).set_edge_rule(v1::EDGE_RULE_EXTEND); }));
  EXPECT_TRUE(differs([](Request& r) {
    AddRing({0, 0, 9, 0, 0, 9}, SelectionOf(r).mutable_boundary_xy_mm());
  }));
  EXPECT_TRUE(differs([](Request& r) {
    AddRing({0, 0, 1, 0, 0, 1}, SetupOf(r).add_obstacles()->mutable_outline_xy_mm());
  }));
  EXPECT_TRUE(differs([](Request& r) { HeightsOf(r).set_clearance_above_mm(9); }));
  EXPECT_TRUE(differs([](Request& r) { HeightsOf(r).set_clearance_z_mm(9); }));
  EXPECT_TRUE(differs([](Request& r) { r.mutable_post()->set_work_offset("G55"); }));
  EXPECT_TRUE(differs([](Request& r) { r.mutable_post()->set_dialect("fanuc"); }));
  EXPECT_TRUE(differs([](Request& r) { r.mutable_post()->set_program_number(7); }));
  EXPECT_TRUE(differs([](Request& r) { r.mutable_post()->set_control_deviation_mm(0.001); }));
  EXPECT_TRUE(differs([](Request& r) { r.mutable_post()->set_post_file(LinuxCnc().text + "# ours\n"); }));
  EXPECT_TRUE(differs([](Request& r) { r.mutable_job()->set_name("part"); }));
}

}  // namespace
}  // namespace patchmill
