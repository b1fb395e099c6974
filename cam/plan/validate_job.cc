#include <cmath>

#include <fmt/format.h>

#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "core/base/error_details.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// Nothing sensible lies beyond; keeps coordinates far from where doubles lose 1e-9 mm.
constexpr double kMaxLength = 1e5;   // mm
constexpr double kMinRadius = 0.01;  // mm
constexpr double kMaxRadius = 500.0;
constexpr double kMinTolerance = 1e-4;  // mm: four decimals of the program take 5e-5 of it

absl::Status Range(const char* field, double value, bool ok, const std::string& constraint) {
  if (ok && std::isfinite(value)) return absl::OkStatus();
  return FieldError(field, fmt::format("= {:.6g}; must be {}", value, constraint));
}

constexpr double kMaxAvoidMargin = 100.0, kMaxWiden = 1000.0;  // mm; kMaxWiden: other margins and offsets

absl::Status ValidateOutline(const std::string& field, const std::vector<Ring>& rings) {
  const std::string fault = OutlineFault(rings);
  return fault.empty() ? absl::OkStatus() : FieldError(field, "is no outline: " + fault);
}

// Where the tool may be and what is wanted.
absl::Status ValidateLimits(const Job& job) {
  const Selection& s = job.operation.selection;
  PM_RETURN_IF_ERROR(Range("selection.avoid_margin_mm", s.avoid_margin,
                           s.avoid_margin >= 0 && s.avoid_margin <= kMaxAvoidMargin,
                           fmt::format("in [0, {}]", kMaxAvoidMargin)));
  PM_RETURN_IF_ERROR(Range("selection.boundary_offset_mm", s.boundary_offset,
                           std::abs(s.boundary_offset) <= kMaxWiden,
                           fmt::format("in [-{0}, {0}]", kMaxWiden)));
  if (!s.boundary.empty()) PM_RETURN_IF_ERROR(ValidateOutline("selection.boundary_xy_mm", s.boundary));
  for (std::size_t i = 0; i < job.setup.obstacles.size(); ++i) {
    const ObstacleOutline& o = job.setup.obstacles[i];
    const std::string at = fmt::format("setup.obstacles[{}].", i);
    PM_RETURN_IF_ERROR(ValidateOutline(at + "outline_xy_mm", {o.outline}));
    PM_RETURN_IF_ERROR(Range((at + "top_z_mm").c_str(), o.top_z, std::abs(o.top_z) <= kMaxLength,
                             fmt::format("in [-{0}, {0}]", kMaxLength)));
    PM_RETURN_IF_ERROR(Range((at + "margin_mm").c_str(), o.margin, o.margin >= 0 && o.margin <= kMaxWiden,
                             fmt::format("in [0, {}]", kMaxWiden)));
  }
  return absl::OkStatus();
}

// The rounding of coordinates and what the control does must fit into the tolerance.
absl::Status ValidatePost(const Job& job) {
  const Dialect& dialect = job.dialect;
  const double tolerance = job.operation.tolerance, share = SplitBudget(tolerance).controller;
  const Coolant coolant = job.operation.tool.coolant;
  if (coolant != Coolant::kOff && CoolantLine(dialect, coolant).empty()) {
    return FieldError("tool.coolant",
                      fmt::format("is not what the dialect {} has a word for; add it to [coolant] "
                                  "of a post file of your own, or switch it off",
                                  dialect.name));
  }
  if (job.control_deviation) {
    const double deviation = *job.control_deviation;
    if (dialect.assumed_path.empty()) {
      return FieldError("post.control_deviation_mm",
                        fmt::format("= {:.6g}; must be unset: the dialect {} says itself how far the control "
                                    "leaves the path",
                                    deviation, dialect.name));
    }
    if (!(deviation > 0.0 && deviation <= share)) {
      return FieldError("post.control_deviation_mm",
                        fmt::format("= {:.6g}; must be in (0, {:.6g}], the control's share of tolerance_mm = "
                                    "{:.6g}; raise the tolerance, or leave it unset for exact stop",
                                    deviation, share, tolerance));
    }
  }
  // The share of a control that follows exactly is free for the rounding.
  const bool exact = dialect.follows_exactly || (dialect.path_tolerance.empty() && !job.control_deviation);
  const double room = SplitBudget(tolerance).rounding + (exact ? share : 0.0);
  constexpr double kFine = 1.001e-4;  // mm; finer decimals are within every budget
  const double tick = TickOf(dialect, job.unit), rounding = 0.5 * std::sqrt(3.0) * tick;
  if (tick > kFine && rounding > room) {
    return FieldError("tolerance_mm",
                      fmt::format("= {:.6g}; must be at least {:.4g} for the {} decimals of the dialect {}{}",
                                  tolerance, tolerance * rounding / room, dialect.decimals[job.unit],
                                  dialect.name, job.unit == ProgramUnit::kInch ? " in inches" : ""));
  }
  return absl::OkStatus();
}

// Leads, links and depths.
absl::Status ValidateMotion(const Operation& op) {
  constexpr double kMost = 1000.0;
  if (op.lead_radius) {
    PM_RETURN_IF_ERROR(Range("leads.radius_mm", *op.lead_radius,
                             *op.lead_radius > 0.0 && *op.lead_radius <= kMost, "in (0, 1000]"));
  }
  PM_RETURN_IF_ERROR(Range(
      "leads.sweep_deg", Degrees(op.lead_sweep),
      op.lead_sweep >= Radians(kMinLeadSweepDeg) - 1e-9 && op.lead_sweep <= Radians(kMaxLeadSweepDeg) + 1e-9,
      fmt::format("in [{:g}, {:g}]", kMinLeadSweepDeg, kMaxLeadSweepDeg)));
  PM_RETURN_IF_ERROR(Range(
      "feeds.plunge_angle_deg", Degrees(op.plunge_angle),
      op.plunge_angle >= Radians(kMinPlungeAngleDeg) - 1e-9 && op.plunge_angle <= kDefaultPlungeAngle + 1e-9,
      fmt::format("in [{:g}, {:g}]", kMinPlungeAngleDeg, Degrees(kDefaultPlungeAngle))));
  const auto feed = [](const char* field, const std::optional<double>& f) {
    return f ? Range(field, *f, *f >= 0.1 && *f <= 1e6, "in [0.1, 1e6]") : absl::OkStatus();
  };
  PM_RETURN_IF_ERROR(feed("feeds.link_mm_per_min", op.link_feed));
  PM_RETURN_IF_ERROR(feed("feeds.lead_mm_per_min", op.lead_feed));
  return Range("accept_depth_mm", op.accept_depth, op.accept_depth >= 0.0 && op.accept_depth <= kMost,
               "in [0, 1000]");
}

}  // namespace

absl::Status ValidateJob(const Job& job) {
  const Operation& op = job.operation;
  const Tool& tool = op.tool;
  const double r = BallRadius(tool);
  const auto check = [](const char* field, double value, bool ok, std::string constraint) {
    return Range(field, value, ok, constraint);
  };
  PM_RETURN_IF_ERROR(check("tool.ball_end.diameter_mm", 2 * r, r >= kMinRadius && r <= kMaxRadius,
                           fmt::format("in [{}, {}]", 2 * kMinRadius, 2 * kMaxRadius)));
  PM_RETURN_IF_ERROR(check("tool.spindle_rpm", tool.spindle_rpm,
                           tool.spindle_rpm >= 1.0 && tool.spindle_rpm <= 1e6, "in [1, 1e6]"));
  PM_RETURN_IF_ERROR(
      check("tool.feed_mm_per_min", tool.feed, tool.feed >= 0.1 && tool.feed <= 1e6, "in [0.1, 1e6]"));
  PM_RETURN_IF_ERROR(check("tool.plunge_feed_mm_per_min", tool.plunge_feed,
                           tool.plunge_feed >= 0.1 && tool.plunge_feed <= 1e6, "in [0.1, 1e6]"));
  PM_RETURN_IF_ERROR(
      check("tool.number", tool.number, tool.number >= 1 && tool.number <= 99999, "in [1, 99999]"));
  if (tool.flute_length) {
    PM_RETURN_IF_ERROR(check("tool.flute_length_mm", *tool.flute_length, *tool.flute_length > 0, "above 0"));
  }
  if (tool.shank_diameter) {
    PM_RETURN_IF_ERROR(
        check("tool.shank_diameter_mm", *tool.shank_diameter, *tool.shank_diameter > 0, "above 0"));
    if (*tool.shank_diameter > 2 * r + 1e-9 && !tool.flute_length) {
      return FieldError(
          "tool.flute_length_mm",
          fmt::format("is missing; required when shank_diameter_mm = {:.6g} is wider than the cutter",
                      *tool.shank_diameter));
    }
  }
  if (tool.stickout)
    PM_RETURN_IF_ERROR(check("tool.stickout_mm", *tool.stickout, *tool.stickout > 0, "above 0"));
  if (op.keep_feed && !StockIsStated(job.setup)) {
    return FieldError(
        "feeds.keep_on_passes",
        "= true; needs the stock to be stated (setup.stock.allowance_mm, or a body of the stock)");
  }
  if (op.keep_feed && op.accept_depth > job.setup.allowance.Least()) {
    return FieldError(
        "feeds.keep_on_passes",
        fmt::format("= true; must be false where accept_depth_mm = {:.6g} is more than the allowance, "
                    "{:.6g}: descents may then cut deep",
                    op.accept_depth, job.setup.allowance.Least()));
  }
  if (op.corner_feed) {
    PM_RETURN_IF_ERROR(check("feeds.corner_mm_per_min", *op.corner_feed,
                             *op.corner_feed >= 0.1 && *op.corner_feed <= tool.feed,
                             fmt::format("in [0.1, the feed of the tool = {:.6g}]", tool.feed)));
  }
  if (!tool.holder.empty() && !tool.stickout)
    return FieldError("tool.stickout_mm", "is missing; required with a holder: it says where that begins");
  for (const HolderSegment& segment : tool.holder) {
    if (!(segment.length > 0.0 && segment.lower_diameter > 0.0 && segment.upper_diameter > 0.0))
      return FieldError("tool.holder", "must have lengths and diameters above 0");
  }
  PM_RETURN_IF_ERROR(check("tool.holder_clearance_mm", tool.holder_clearance,
                           tool.holder_clearance >= 0.0 && tool.holder_clearance <= 100.0, "in [0, 100]"));
  if (!tool.holder.empty() && tool.holder_clearance < job.setup.allowance.Most()) {
    return FieldError(
        "tool.holder_clearance_mm",
        fmt::format("= {:.6g}; must be at least the stock allowance, {:.6g}: so much may stand on the "
                    "surface",
                    tool.holder_clearance, job.setup.allowance.Most()));
  }
  PM_RETURN_IF_ERROR(check("scallop_mm", op.scallop, op.scallop > 0 && op.scallop < r,
                           fmt::format("in (0, ball radius = {:.6g})", r)));
  PM_RETURN_IF_ERROR(check("tolerance_mm", op.tolerance,
                           op.tolerance >= kMinTolerance && op.tolerance <= 0.5 * r,
                           fmt::format("in [{}, half the ball radius = {:.6g}]", kMinTolerance, 0.5 * r)));
  PM_RETURN_IF_ERROR(check("stock_to_leave_mm", op.leave, op.leave >= 0 && op.leave <= 100, "in [0, 100]"));
  PM_RETURN_IF_ERROR(check("steep_angle_deg", Degrees(op.steep_angle),
                           op.steep_angle >= Radians(5) && op.steep_angle <= Radians(85), "in [5, 85]"));
  PM_RETURN_IF_ERROR(check("zigzag_bend_deg", Degrees(op.zigzag_bend),
                           op.zigzag_bend >= 0.0 && op.zigzag_bend <= Radians(kMaxZigzagBendDeg),
                           fmt::format("in [0, {:g}]", kMaxZigzagBendDeg)));
  PM_RETURN_IF_ERROR(check("zigzag_angle_deg", Degrees(op.zigzag_angle), std::abs(op.zigzag_angle) <= 2 * kPi,
                           "in [-360, 360]"));
  PM_RETURN_IF_ERROR(check("detail", op.detail, op.detail >= 0 && op.detail <= 1, "in [0, 1]"));
  PM_RETURN_IF_ERROR(check("heights.approach_gap_mm", op.approach_gap,
                           op.approach_gap > 0 && op.approach_gap <= 100, "in (0, 100]"));
  if (op.clearance_above) {
    PM_RETURN_IF_ERROR(check("heights.clearance_above_mm", *op.clearance_above,
                             *op.clearance_above > 0 && *op.clearance_above <= kMaxLength,
                             fmt::format("in (0, {}]", kMaxLength)));
  }
  const StockDepth& allowance = job.setup.allowance;
  const auto check_allowance = [&](const char* field, double value) {
    PM_RETURN_IF_ERROR(check(field, value, value >= 0 && value <= 100, "in [0, 100]"));
    return check(field, value, value >= op.leave,
                 fmt::format("at least stock_to_leave_mm = {:.6g}", op.leave));
  };
  if (allowance.IsOne()) {
    PM_RETURN_IF_ERROR(check_allowance("setup.stock.allowance_mm", allowance.walls));
  } else {
    PM_RETURN_IF_ERROR(check_allowance("setup.stock.wall_allowance_mm", allowance.walls));
    PM_RETURN_IF_ERROR(check_allowance("setup.stock.floor_allowance_mm", allowance.floors));
  }
  const auto length = [&](const char* field, const std::optional<double>& z) {
    return z ? check(field, *z, std::abs(*z) <= kMaxLength, fmt::format("in [-{0}, {0}]", kMaxLength))
             : absl::OkStatus();
  };
  PM_RETURN_IF_ERROR(length("heights.clearance_z_mm", op.clearance_z));
  PM_RETURN_IF_ERROR(length("heights.floor_z_mm", op.floor_z));
  PM_RETURN_IF_ERROR(length("heights.top_z_mm", op.top_z));
  if (op.floor_z && op.top_z && *op.top_z < *op.floor_z) {
    return FieldError("heights.top_z_mm",
                      fmt::format("= {:.6g}; must be at least floor_z_mm = {:.6g}", *op.top_z, *op.floor_z));
  }
  PM_RETURN_IF_ERROR(ValidateMotion(op));
  PM_RETURN_IF_ERROR(ValidateLimits(job));
  PM_RETURN_IF_ERROR(length("setup.stock.top_z_mm", job.setup.stock_top_z));
  PM_RETURN_IF_ERROR(length("setup.program_zero.x_mm", job.setup.zero_point.x()));
  PM_RETURN_IF_ERROR(length("setup.program_zero.y_mm", job.setup.zero_point.y()));
  PM_RETURN_IF_ERROR(length("setup.program_zero.z_mm", job.setup.zero_point.z()));
  PM_RETURN_IF_ERROR(ValidatePost(job));
  if (!IsWorkOffset(job.work_offset))
    return FieldError("post.work_offset", fmt::format("= \"{}\"; must be G54 to G59", job.work_offset));
  return absl::OkStatus();
}

}  // namespace patchmill
