#include "cam/plan/job_findings.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include "cam/path/stepover/step_over.h"

namespace patchmill {
namespace {

const char* NameOf(const decltype(Setup::stock_body)& body) {
  if (std::holds_alternative<BlockStock>(body)) return "block";
  if (std::holds_alternative<CylinderStock>(body)) return "cylinder";
  if (std::holds_alternative<ModelStock>(body)) return "stock model";
  return "prism";
}

struct MissedArea {
  UnreachableReason reason = UnreachableReason::kNone;
  double area = 0.0;  // mm2
};

// The areas of UnreachedShare.
std::vector<MissedArea> MissedAreas(const VerifyReport& report, const Operation& op) {
  const EnumArray<UncutReason, double>& area = report.unreachable_plan_area;
  std::vector<MissedArea> missed = {{UnreachableReason::kConcave, area[UncutReason::kConcave]},
                                    {UnreachableReason::kShank, area[UncutReason::kShank]},
                                    {UnreachableReason::kHolder, area[UncutReason::kHolder]}};
  if (!op.floor_z) missed.push_back({UnreachableReason::kFloor, area[UncutReason::kFloor]});
  return missed;
}

std::string CureOf(UnreachableReason reason) {
  switch (reason) {
    case UnreachableReason::kConcave:
      return "a smaller ball";
    case UnreachableReason::kShank:
      return "a longer flute (--flute-length)";
    case UnreachableReason::kHolder:
      return "a longer stick-out (--stickout)";
    default:
      return "a lower --floor";
  }
}

double SumOf(const std::vector<MissedArea>& missed) {
  double sum = 0.0;
  for (const MissedArea& part : missed) sum += part.area;
  return sum;
}

// The tip of a ball whose centre is there, placed frame.
Vec3 TipAt(const Vec3& center, const Resolved& resolved) { return center - Vec3(0.0, 0.0, resolved.radius); }

// As seen from above, and at the top.
bool Encloses(const Box3& stock, const Box3& part) {
  constexpr double kSlack = 1e-3;  // mm
  return (stock.min.head<2>().array() <= part.min.head<2>().array() + kSlack).all() &&
         (stock.max.array() >= part.max.array() - kSlack).all();
}

}  // namespace

Diagnostics Assumptions(const Job& job, const Resolved& r) {
  Diagnostics list;
  const double zero_z = r.program_zero.z();
  const StockDepth& allowance = job.setup.allowance;
  std::string stock =
      allowance.IsOne()
          ? fmt::format("at most {:.3g} mm of material on the surface", allowance.walls)
          : fmt::format("at most {:.3g} mm of material on walls and {:.3g} mm on floors of the surface",
                        allowance.walls, allowance.floors);
  if (r.stock == nullptr) {
    stock += ", none beside it";
  } else if (job.setup.allowance_stated) {
    stock += fmt::format(", the rest of the {} beside it", NameOf(job.setup.stock_body));
  } else {
    stock = fmt::format("a whole {}, from which nothing has been cut", NameOf(job.setup.stock_body));
  }
  stock += fmt::format(", nothing above Z{:.4f}", r.stock_top_z - zero_z);
  if (r.stock_box && !Encloses(*r.stock_box, r.box)) {
    const Box3& box = *r.stock_box;
    stock += fmt::format(
        ". The stock model does not enclose the part: it reaches from X{:.4g} Y{:.4g} Z{:.4g} to X{:.4g} "
        "Y{:.4g} "
        "Z{:.4g}",
        box.min.x() - r.program_zero.x(), box.min.y() - r.program_zero.y(), box.min.z() - zero_z,
        box.max.x() - r.program_zero.x(), box.max.y() - r.program_zero.y(), box.max.z() - zero_z);
  }
  const Tool& tool = job.operation.tool;
  if (job.default_tool_number)
    list.push_back(
        MakeWarning("TOOL_NUMBER_ASSUMED", fmt::format("no tool number is given: T{}", tool.number)));
  if (!job.setup.zero_stated)
    list.push_back(MakeWarning("ZERO_ASSUMED", "no zero is given: X0 Y0 Z0 is the model's own origin"));
  list.push_back(StockIsStated(job.setup) ? MakeWarning("STOCK_STATED", stock)
                                          : MakeWarning("STOCK_ASSUMED", "assumed: " + stock));
  if (r.stock != nullptr && job.operation.accept_depth > allowance.Least()) {
    list.push_back(MakeWarning(
        "DEPTH_ACCEPTED",
        fmt::format("cuts up to {:.3g} mm deep into the stock are accepted", job.operation.accept_depth)));
  }
  if (StockIsStated(job.setup) && !job.operation.high_rapids) {
    list.push_back(
        MakeWarning("LOW_RAPIDS",
                    "rapids between passes go below the clearance plane, clear of that material however "
                    "the control drives its axes"));
  }
  if (job.operation.tool.holder.empty()) {
    list.push_back(MakeWarning("HOLDER_NOT_CHECKED",
                               "no holder is given, so none is checked; see required_stickout_mm"));
  }
  if (job.default_cutting_data) {
    list.push_back(MakeWarning(
        "DEFAULT_CUTTING_DATA",
        fmt::format(
            "spindle {:.0f} rpm, feed {:.0f} and plunge feed {:.0f} mm/min: not all are given, and defaults "
            "are not made for this material",
            job.operation.tool.spindle_rpm, job.operation.tool.feed, job.operation.tool.plunge_feed)));
  }
  if (job.operation.tool.plunge_feed > job.operation.tool.feed) {
    list.push_back(
        MakeWarning("PLUNGE_FEED_ABOVE_FEED",
                    fmt::format("descents steeper than {:.0f} degrees run at {:.6g} mm/min, faster "
                                "than the feed, {:.6g} mm/min",
                                Degrees(job.operation.plunge_angle), job.operation.tool.plunge_feed,
                                job.operation.tool.feed)));
  }
  const double extent = (r.box.max - r.box.min).maxCoeff();
  if (job.unitless_file && (extent < 4.0 * r.radius || extent > 2000.0)) {
    list.push_back(
        MakeWarning("SUSPICIOUS_SIZE",
                    fmt::format("the model is {:.4g} mm large for a ball of diameter {:.4g} mm and its file "
                                "states no unit: is --scale right?",
                                extent, 2.0 * r.radius)));
  }
  return list;
}

bool IsToCheckBeforeStart(std::string_view code) {
  constexpr std::string_view kCodes[] = {"TOOL_NUMBER_ASSUMED", "DEFAULT_CUTTING_DATA", "ZERO_ASSUMED",
                                         "STOCK_ASSUMED", "HOLDER_NOT_CHECKED"};
  return std::find(std::begin(kCodes), std::end(kCodes), code) != std::end(kCodes);
}

Diagnostic NothingToCut(const JobReport& report, const Resolved& resolved, bool limited, double reached) {
  double all = 0.0, off = 0.0, on = 0.0, outside = 0.0;
  double avoided = 0.0, shank = 0.0, holder = 0.0, strategy = 0.0;
  for (const Region& region : report.regions) {
    const auto id = region.id.index();
    const double wanted = report.figures[id].selected_share * region.area;
    all += wanted;
    if (region.kind != RegionKind::kUnreachable) (report.choices[id].skip ? off : on) += wanted;
    if (region.reason == UnreachableReason::kOutside) outside += wanted;
    if (region.reason == UnreachableReason::kAvoided) avoided += wanted;
    if (region.reason == UnreachableReason::kShank) shank += wanted;
    if (region.reason == UnreachableReason::kHolder) holder += wanted;
    if (region.reason == UnreachableReason::kStrategy) strategy += wanted;
  }
  const Vec3 size = resolved.box.max - resolved.box.min;
  const std::string scale = fmt::format("--scale ({:.4g} x {:.4g} x {:.4g} mm now), then --up and --floor",
                                        size.x(), size.y(), size.z());
  if (off > 0.0 && !(on > 0.0)) {
    return MakeWarning(
        "NOTHING_TO_CUT",
        fmt::format("all that is wanted and a ball of diameter {:.4g} mm reaches, {:.1f} mm2, is in "
                    "regions that are switched off",
                    2.0 * resolved.radius, off));
  }
  const std::string limits = "the selection, the boundary, the regions, --top and the obstacles";
  std::string shares;
  const auto tell = [&](double area, const char* reason) {
    if (!(area > 0.0)) return;
    shares += fmt::format("{}{:.0f} % of it is {}", shares.empty() ? " (" : ", ", 100.0 * area / all, reason);
  };
  tell(outside, Name(UnreachableReason::kOutside));
  tell(avoided, Name(UnreachableReason::kAvoided));
  tell(shank, Name(UnreachableReason::kShank));
  tell(holder, Name(UnreachableReason::kHolder));
  tell(strategy, Name(UnreachableReason::kStrategy));
  if (!shares.empty()) shares += ")";
  std::string look = limited ? scale + ", then " + limits : scale;
  if (avoided >= 0.5 * all) look = limits + ", then " + scale;
  if (outside > 0.5 * all) look = "--outside, or the walls' names in --only, then " + scale;
  if (shank > 0.5 * all) look = "the length of flutes and the shank, then " + scale;
  if (holder > 0.5 * all) look = "--stickout and the holder, then " + scale;
  if (strategy > 0.5 * all) look = "the forced strategy, then " + scale;
  const char* of = limited ? "that is wanted" : "of the model";
  const std::string what =
      reached > 0.0
          ? fmt::format(
                "a ball of diameter {:.4g} mm reaches {:.3g} of {:.3g} mm2 {}, less than a square of "
                "its step-over",
                2.0 * resolved.radius, reached, all, of)
          : fmt::format("no point {} can be reached with a ball of diameter {:.4g} mm", of,
                        2.0 * resolved.radius);
  return MakeWarning("NOTHING_TO_CUT", fmt::format("{}{}: check {}", what, shares, look));
}

Diagnostic NeedsRoughing(const DeepCuts& deep, const Job& job, const Resolved& resolved) {
  const double step = CenterStep(resolved.plan_radius, job.operation.scallop, 0.0);
  const Vec3 tip = TipAt(deep.center, resolved) - resolved.program_zero;
  const StockDepth& most = resolved.depth_limit;
  const std::string limit =
      most.IsOne() ? fmt::format("{:.3g} mm", most.walls)
                   : fmt::format("{:.3g} mm from the side or {:.3g} mm from above", most.walls, most.floors);
  const std::string stated = job.setup.allowance_stated
                                 ? ""
                                 : ", say --allowance if the stock over the part has been roughed to it,";
  Diagnostic d = MakeError(
      "NEEDS_ROUGHING",
      fmt::format(
          "the ball would cut {:.3g} mm deep into the stock at X{:.4f} Y{:.4f} Z{:.4f}, and more than "
          "{} deep over about {:.3g} mm2: rough it first{} or raise --accept-depth",
          deep.deepest, tip.x(), tip.y(), tip.z(), limit, deep.length * step, stated),
      {});
  d.where.point = TipAt(deep.center, resolved);
  return d;
}

double UnreachedShare(const VerifyReport& report, const Operation& op) {
  const double missed = SumOf(MissedAreas(report, op));
  return missed > 0.0 ? missed / (missed + report.reachable_plan_area) : 0.0;
}

Diagnostic TooMuchUnreached(const VerifyReport& report, const Operation& op, double share) {
  std::vector<MissedArea> missed = MissedAreas(report, op);
  std::stable_sort(missed.begin(), missed.end(),
                   [](const MissedArea& a, const MissedArea& b) { return a.area > b.area; });
  std::string reasons, cures;
  for (const auto& [reason, area] : missed) {
    if (!(area > 0.0)) continue;
    reasons += fmt::format("{}{} {:.0f} %", reasons.empty() ? "" : ", ", Name(reason),
                           100.0 * share * area / SumOf(missed));
    cures += CureOf(reason) + ", ";
  }
  return MakeError(
      "TOO_MUCH_UNREACHED",
      fmt::format(
          "the tool does not fit into {:.1f} % of what looks up, as seen from above ({}), and at most "
          "{:.6g} % may stay uncut: take {}or raise --max-unreached",
          100.0 * share, reasons, 100.0 * op.max_unreached, cures),
      {});
}

Diagnostics SteepLeads(const std::vector<LeadFigure>& leads, const Resolved& resolved) {
  constexpr std::size_t kMost = 20;
  Diagnostics list;
  for (const LeadFigure& lead : leads) {
    if (lead.kind != LeadKind::kStraight || !lead.in || list.size() >= kMost) continue;
    const Vec3 tip = TipAt(lead.place, resolved) - resolved.program_zero;
    list.push_back(MakeWarning(
        "STEEP_LEAD",
        fmt::format("the tool comes onto a pass from beside or above it at X{:.4f} Y{:.4f} Z{:.4f}: there is "
                    "no room for an arc of {:.3g} mm, and the pass is too short for a ramp",
                    tip.x(), tip.y(), tip.z(), kLeastLeadRadius)));
    list.back().where.point = TipAt(lead.place, resolved);
  }
  return list;
}

}  // namespace patchmill
