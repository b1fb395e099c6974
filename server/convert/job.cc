#include "server/convert/job.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "server/convert/enums.h"
#include "server/convert/fields.h"
#include "server/convert/outline.h"
#include "server/convert/overrides.h"
#include "server/convert/setup.h"
#include "server/limits.h"

namespace patchmill {
namespace {

void ReadHeights(const v1::Heights& proto, const std::string& at, Operation& op, FieldErrors& errors) {
  constexpr double kMost = limits::kMaxCoordinateMm;
  const auto height = [&](const char* name, double z) {
    Require(errors, At(at, name), z, std::abs(z) <= kMost, fmt::format("in [{}, {}]", -kMost, kMost));
    return z;
  };
  if (proto.has_clearance_z_mm()) op.clearance_z = height("clearance_z_mm", proto.clearance_z_mm());
  if (proto.has_floor_z_mm()) op.floor_z = height("floor_z_mm", proto.floor_z_mm());
  if (proto.has_clearance_above_mm()) {
    const double above = proto.clearance_above_mm();
    Require(errors, At(at, "clearance_above_mm"), above, above > 0.0 && above <= limits::kMaxClearanceAboveMm,
            fmt::format("in (0, {}]", limits::kMaxClearanceAboveMm));
    if (proto.has_clearance_z_mm()) {
      errors.Add(At(at, "clearance_above_mm"), "is set together with clearance_z_mm; set at most one");
    }
    op.clearance_above = above;
  }
  if (proto.has_approach_gap_mm()) {
    op.approach_gap = proto.approach_gap_mm();
    Require(errors, At(at, "approach_gap_mm"), op.approach_gap,
            op.approach_gap > 0.0 && op.approach_gap <= limits::kMaxApproachGapMm,
            fmt::format("in (0, {}]", limits::kMaxApproachGapMm));
  }
  if (proto.has_top_z_mm()) op.top_z = height("top_z_mm", proto.top_z_mm());
  op.high_rapids = proto.high_rapids();
}

void ReadLeads(const v1::Leads& proto, const std::string& at, Operation& op, FieldErrors& errors) {
  if (proto.has_radius_mm()) {
    op.lead_radius = proto.radius_mm();
    Require(errors, At(at, "radius_mm"), *op.lead_radius,
            *op.lead_radius > 0.0 && *op.lead_radius <= limits::kMaxDepthMm,
            fmt::format("in (0, {}]", limits::kMaxDepthMm));
  }
  if (proto.has_sweep_deg()) {
    Require(errors, At(at, "sweep_deg"), proto.sweep_deg(),
            proto.sweep_deg() >= kMinLeadSweepDeg && proto.sweep_deg() <= kMaxLeadSweepDeg,
            fmt::format("in [{:g}, {:g}]", kMinLeadSweepDeg, kMaxLeadSweepDeg));
    op.lead_sweep = Radians(proto.sweep_deg());
  }
}

void ReadFeeds(const v1::Feeds& proto, const std::string& at, Operation& op, FieldErrors& errors) {
  if (proto.has_plunge_angle_deg()) {
    // Thirty degrees may be stated, though their radians come back as a little less.
    const double most = std::round(Degrees(kDefaultPlungeAngle));
    Require(errors, At(at, "plunge_angle_deg"), proto.plunge_angle_deg(),
            proto.plunge_angle_deg() >= kMinPlungeAngleDeg && proto.plunge_angle_deg() <= most,
            fmt::format("in [{:g}, {:g}]", kMinPlungeAngleDeg, most));
    op.plunge_angle = std::min(Radians(proto.plunge_angle_deg()), kDefaultPlungeAngle);
  }
  const auto feed = [&](const char* name, double value) {
    Require(errors, At(at, name), value, value >= limits::kMinFeed && value <= limits::kMaxFeed,
            fmt::format("in [{:g}, {:g}]", limits::kMinFeed, limits::kMaxFeed));
    return value;
  };
  op.keep_feed = proto.keep_on_passes();
  if (proto.has_link_mm_per_min()) op.link_feed = feed("link_mm_per_min", proto.link_mm_per_min());
  if (proto.has_lead_mm_per_min()) op.lead_feed = feed("lead_mm_per_min", proto.lead_mm_per_min());
  if (proto.has_corner_mm_per_min()) op.corner_feed = feed("corner_mm_per_min", proto.corner_mm_per_min());
}

void CheckSpindle(const Tool& tool, const Machine& machine, const std::string& at, FieldErrors& errors) {
  if (machine.spindle_max <= 0.0) return;
  Require(errors, At(at, "spindle_rpm"), tool.spindle_rpm,
          tool.spindle_rpm >= machine.spindle_min && tool.spindle_rpm <= machine.spindle_max,
          fmt::format("in the range of the machine, [{:g}, {:g}]", machine.spindle_min, machine.spindle_max));
}

void ReadPost(const v1::Post& proto, Job& job, FieldErrors& errors) {
  job.dialect = ReadDialect(proto.dialect(), proto.post_file(), "post.", errors);
  job.arcs = !proto.has_arcs() || proto.arcs();
  job.restart_points = proto.restart_points();
  if (job.restart_points && job.dialect.restart.empty()) {
    errors.Add("post.restart_points",
               fmt::format("= true; the dialect {} has no section [restart]", job.dialect.name));
  }
  if (proto.has_line_number_step()) {
    const int step = proto.line_number_step();
    Require(errors, "post.line_number_step", step, step >= 0 && step <= kMaxLineNumberStep,
            fmt::format("in [0, {}]", kMaxLineNumberStep));
    job.line_number_step = step;
  }
  if (proto.unit() == v1::LENGTH_UNIT_INCH) {
    job.unit = ProgramUnit::kInch;
    if (!HasUnit(job.dialect, job.unit)) {
      errors.Add(
          "post.unit",
          fmt::format("= inches; the dialect {} has none: its file needs unit_mm, unit_inch and {{unit}}",
                      job.dialect.name));
    }
  } else if (proto.unit() != v1::LENGTH_UNIT_UNSPECIFIED && proto.unit() != v1::LENGTH_UNIT_MILLIMETER) {
    errors.Add("post.unit",
               fmt::format("= {}; must be millimetres or inches", static_cast<int>(proto.unit())));
  }
  if (!proto.work_offset().empty()) {
    const std::string& w = proto.work_offset();
    if (!(w.size() == 3 && w[0] == 'G' && w[1] == '5' && w[2] >= '4' && w[2] <= '9')) {
      errors.Add("post.work_offset", fmt::format("= \"{}\"; must be one of G54 to G59", w.substr(0, 50)));
    }
    job.work_offset = w;
  }
  if (proto.program_number() != 0) {
    Require(errors, "post.program_number", proto.program_number(),
            proto.program_number() >= 1 && proto.program_number() <= 9999, "in [1, 9999]");
    job.program_number = proto.program_number();
  }
  if (proto.has_control_deviation_mm()) {
    job.control_deviation = ReadControlDeviation(proto.control_deviation_mm(), "post.", errors);
  }
  if (proto.has_spindle_dwell_s()) errors.NotYet("post.spindle_dwell_s", "leave it unset");
}

}  // namespace

Dialect ReadDialect(const std::string& name, const std::string& post_file, const std::string& at,
                    FieldErrors& errors) {
  if (!post_file.empty()) {
    absl::StatusOr<Dialect> own = ParseDialect(post_file);
    if (own.ok()) return *std::move(own);
    errors.Add(at + "post_file", std::string(own.status().message()));
    return LinuxCnc();
  }
  if (name.empty()) return LinuxCnc();
  if (const Dialect* known = FindDialect(name)) return *known;
  errors.Add(at + "dialect", fmt::format("= \"{}\"; must be one of: {}", name.substr(0, 50), DialectNames()));
  return LinuxCnc();
}

double ReadControlDeviation(double deviation_mm, const std::string& at, FieldErrors& errors) {
  Require(errors, at + "control_deviation_mm", deviation_mm, deviation_mm > 0.0 && deviation_mm <= 1.0,
          "in (0, 1]");
  return deviation_mm;
}

double ReadSteepAngle(double degrees, std::string_view at, FieldErrors& errors) {
  Require(errors, At(at, "steep_angle_deg"), degrees,
          degrees >= limits::kMinSteepDeg && degrees <= limits::kMaxSteepDeg,
          fmt::format("in [{}, {}]", limits::kMinSteepDeg, limits::kMaxSteepDeg));
  return Radians(degrees);
}

double ReadDetail(double detail, std::string_view at, FieldErrors& errors) {
  Require(errors, At(at, "detail"), detail, detail >= 0.0 && detail <= 1.0, "in [0, 1]");
  return detail;
}

double ReadAcceptDepth(double depth_mm, std::string_view at, FieldErrors& errors) {
  Require(errors, At(at, "accept_depth_mm"), depth_mm, depth_mm >= 0.0 && depth_mm <= limits::kMaxDepthMm,
          fmt::format("in [0, {}]", limits::kMaxDepthMm));
  return depth_mm;
}

Operation FromProto(const v1::Operation& proto, std::string_view at, FieldErrors& errors) {
  Operation op;
  RequireBytes(errors, At(at, "id"), proto.id(), limits::kMaxIdBytes);
  op.id = proto.id();
  if (proto.has_tool()) {
    op.tool = FromProto(proto.tool(), At(at, "tool"), CuttingData::kRequired, errors);
  } else {
    errors.Missing(At(at, "tool"));
  }
  const double radius = BallRadius(op.tool);
  op.scallop = proto.scallop_mm();
  Require(errors, At(at, "scallop_mm"), op.scallop, op.scallop > 0.0 && op.scallop < radius,
          fmt::format("in (0, ball radius = {:.10g})", radius));
  op.tolerance = proto.tolerance_mm();
  Require(errors, At(at, "tolerance_mm"), op.tolerance,
          op.tolerance >= limits::kMinToleranceMm && op.tolerance <= 0.5 * radius,
          fmt::format("in [{}, half the ball radius = {:.10g}]", limits::kMinToleranceMm, 0.5 * radius));
  if (proto.has_stock_to_leave_mm()) {
    op.leave = proto.stock_to_leave_mm();
    if (op.leave < 0.0 && op.leave > -radius) {
      errors.NotYet(At(at, "stock_to_leave_mm"),
                    fmt::format("{:.10g} is a spark gap; must be in [0, {}]", op.leave, limits::kMaxLeaveMm));
    } else {
      Require(errors, At(at, "stock_to_leave_mm"), op.leave,
              op.leave >= 0.0 && op.leave <= limits::kMaxLeaveMm,
              fmt::format("in [0, {}]", limits::kMaxLeaveMm));
    }
  }
  if (proto.has_steep_angle_deg()) {
    op.steep_angle = ReadSteepAngle(proto.steep_angle_deg(), at, errors);
  }
  op.strategy = FromProto(proto.strategy(), At(at, "strategy"), errors);
  if (proto.has_zigzag_angle_deg()) {
    const double angle = proto.zigzag_angle_deg();
    Require(errors, At(at, "zigzag_angle_deg"), angle, std::abs(angle) <= 360.0, "in [-360, 360]");
    op.zigzag_angle = Radians(angle);
  }
  if (proto.has_zigzag_bend_deg()) {
    const double bend = proto.zigzag_bend_deg();
    Require(errors, At(at, "zigzag_bend_deg"), bend, bend >= 0.0 && bend <= kMaxZigzagBendDeg,
            fmt::format("in [0, {:g}]", kMaxZigzagBendDeg));
    op.zigzag_bend = Radians(bend);
  }
  op.angle_auto = proto.zigzag_angle_auto();
  if (op.angle_auto && op.zigzag_angle != 0.0) {
    errors.Add(At(at, "zigzag_angle_auto"), "is set, and so is zigzag_angle_deg; set one of them");
  }
  op.one_way = proto.one_way_lines();
  op.spirals = proto.contour_spirals();
  if (proto.has_border_passes()) op.border_passes = proto.border_passes();
  if (proto.has_round_lines()) op.round_lines = proto.round_lines();
  if (proto.has_detail()) op.detail = ReadDetail(proto.detail(), at, errors);
  op.contour_direction = FromProto(proto.contour_direction(), At(at, "contour_direction"), errors);
  op.edge_rule = FromProto(proto.edge_rule(), At(at, "edge_rule"), errors);
  op.selection = FromProto(proto.selection(), At(at, "selection"), errors);
  ReadHeights(proto.heights(), At(at, "heights"), op, errors);
  ReadLeads(proto.leads(), At(at, "leads"), op, errors);
  ReadFeeds(proto.feeds(), At(at, "feeds"), op, errors);
  op.accept_depth = ReadAcceptDepth(proto.accept_depth_mm(), at, errors);
  if (proto.has_max_unreached_fraction()) {
    op.max_unreached = proto.max_unreached_fraction();
    Require(errors, At(at, "max_unreached_fraction"), op.max_unreached,
            op.max_unreached >= 0.0 && op.max_unreached <= 1.0, "in [0, 1]");
  }
  ReadOverrides(proto.regions_sha256(), proto.region_overrides(), at, op, errors);
  return op;
}

Job FromProto(const v1::Job& proto, const v1::Post& post, std::string_view at, FieldErrors& errors) {
  Job job;
  job.setup = FromProto(proto.setup(), At(at, "setup"), errors);
  if (proto.operations().empty()) {
    errors.Missing(At(at, "operations"));
  } else {
    const std::string path = At(at, "operations[0]");
    job.operation = FromProto(proto.operations(0), path, errors);
    if (job.setup.machine) CheckSpindle(job.operation.tool, *job.setup.machine, At(path, "tool"), errors);
    job.default_cutting_data = proto.operations(0).tool().cutting_data_is_default();
    job.default_tool_number = proto.operations(0).tool().number_is_default();
    // The stock to leave is part of the allowance.
    StockDepth& allowance = job.setup.allowance;
    if (!job.setup.allowance_stated) allowance = std::max(allowance.Most(), job.operation.leave);
    if (!proto.operations(0).tool().has_holder_clearance_mm())
      job.operation.tool.holder_clearance = std::max(kDefaultHolderClearance, allowance.Most());
    const auto require = [&](const char* field, double value) {
      if (value >= job.operation.leave) return;
      errors.Add(At(at, field), fmt::format("= {:.10g}; must be at least stock_to_leave_mm = {:.10g}", value,
                                            job.operation.leave));
    };
    if (allowance.IsOne()) {
      require("setup.stock.allowance_mm", allowance.walls);
    } else {
      require("setup.stock.wall_allowance_mm", allowance.walls);
      require("setup.stock.floor_allowance_mm", allowance.floors);
    }
  }
  if (proto.operations_size() > 1) {
    errors.NotYet(At(at, "operations[1]"), "send one operation a job");
  }
  RequireBytes(errors, At(at, "name"), proto.name(), limits::kMaxNameBytes);
  ReadPost(post, job, errors);
  return job;
}

v1::Operation ToProto(const Job& job, const Operation& op) {
  v1::Operation proto;
  *proto.mutable_tool() = ToProto(op.tool);
  proto.mutable_tool()->set_cutting_data_is_default(job.default_cutting_data);
  proto.mutable_tool()->set_number_is_default(job.default_tool_number);
  proto.set_scallop_mm(op.scallop);
  proto.set_tolerance_mm(op.tolerance);
  proto.set_stock_to_leave_mm(op.leave);
  proto.set_steep_angle_deg(Degrees(op.steep_angle));
  proto.set_strategy(ToProto(op.strategy));
  proto.set_id(op.id);
  proto.set_zigzag_angle_deg(Degrees(op.zigzag_angle));
  if (op.one_way) proto.set_one_way_lines(true);
  proto.set_contour_spirals(op.spirals);
  proto.set_border_passes(op.border_passes);
  proto.set_round_lines(op.round_lines);
  proto.set_zigzag_bend_deg(Degrees(op.zigzag_bend));
  proto.set_zigzag_angle_auto(op.angle_auto);
  proto.set_detail(op.detail);
  proto.set_contour_direction(ToProto(op.contour_direction));
  proto.set_edge_rule(ToProto(op.edge_rule));
  v1::Heights& heights = *proto.mutable_heights();
  if (op.clearance_z) {
    heights.set_clearance_z_mm(*op.clearance_z);
  } else {
    heights.set_clearance_above_mm(op.clearance_above.value_or(kDefaultClearanceAbove));
  }
  heights.set_approach_gap_mm(op.approach_gap);
  if (op.high_rapids) heights.set_high_rapids(true);
  if (op.floor_z) heights.set_floor_z_mm(*op.floor_z);
  if (op.top_z) heights.set_top_z_mm(*op.top_z);
  if (op.lead_radius) proto.mutable_leads()->set_radius_mm(*op.lead_radius);
  proto.mutable_leads()->set_sweep_deg(Degrees(op.lead_sweep));
  proto.mutable_feeds()->set_plunge_angle_deg(Degrees(op.plunge_angle));
  if (op.keep_feed) proto.mutable_feeds()->set_keep_on_passes(true);
  if (op.link_feed) proto.mutable_feeds()->set_link_mm_per_min(*op.link_feed);
  if (op.lead_feed) proto.mutable_feeds()->set_lead_mm_per_min(*op.lead_feed);
  if (op.corner_feed) proto.mutable_feeds()->set_corner_mm_per_min(*op.corner_feed);
  proto.set_accept_depth_mm(op.accept_depth);
  proto.set_max_unreached_fraction(op.max_unreached);
  const Selection& s = op.selection;
  if (!s.patches.empty() || !s.avoid.empty() || !s.boundary.empty()) {
    *proto.mutable_selection() = ToProto(s);
  }
  proto.set_regions_sha256(op.regions_sha256);
  for (const RegionOverride& change : op.overrides) *proto.add_region_overrides() = ToProto(change);
  return proto;
}

v1::Job ToProto(const Job& job, std::string_view model_digest, std::string_view name) {
  v1::Job proto;
  proto.mutable_source()->set_model_sha256(std::string(model_digest));
  *proto.mutable_setup() = ToProto(job.setup);
  *proto.add_operations() = ToProto(job, job.operation);
  proto.set_name(Utf8(name));
  return proto;
}

v1::Post PostToProto(const Job& job) {
  v1::Post proto;
  proto.set_dialect(job.dialect.name);
  if (FindDialect(job.dialect.name) == nullptr || FindDialect(job.dialect.name)->text != job.dialect.text)
    proto.set_post_file(job.dialect.text);
  proto.set_program_number(job.program_number);
  if (job.control_deviation) proto.set_control_deviation_mm(*job.control_deviation);
  proto.set_arcs(job.arcs);
  proto.set_restart_points(job.restart_points);
  proto.set_line_number_step(job.line_number_step.value_or(job.dialect.line_number_step));
  proto.set_unit(job.unit == ProgramUnit::kInch ? v1::LENGTH_UNIT_INCH : v1::LENGTH_UNIT_MILLIMETER);
  proto.set_work_offset(job.work_offset);
  return proto;
}

}  // namespace patchmill
