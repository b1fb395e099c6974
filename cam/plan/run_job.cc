#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <absl/strings/numbers.h>
#include <fmt/format.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/limits/upper_cylinders.h"
#include "cam/link/leads.h"
#include "cam/location/limits/operation_limits.h"
#include "cam/path/chord/scan_line.h"
#include "cam/path/stepover/step_over.h"
#include "cam/plan/beside_depth.h"
#include "cam/plan/circular_lines_choice.h"
#include "cam/plan/forced_strategy.h"
#include "cam/plan/job_findings.h"
#include "cam/plan/plan.h"
#include "cam/plan/plan_passes.h"
#include "cam/plan/posted_program.h"
#include "cam/plan/program_sections.h"
#include "cam/plan/quickest_angles.h"
#include "cam/plan/region_choices.h"
#include "cam/plan/region_steps.h"
#include "cam/plan/resolve.h"
#include "cam/plan/unused_settings.h"
#include "cam/post/program_lines.h"
#include "cam/post/program_reader.h"
#include "cam/region/split_regions.h"
#include "cam/toolpath/corner_feeds.h"
#include "cam/toolpath/fit_arcs.h"
#include "cam/toolpath/motion_time.h"
#include "cam/toolpath/straighten.h"
#include "cam/verify/stock_moves.h"
#include "core/base/error_details.h"
#include "core/base/polled_run.h"
#include "core/base/status.h"
#include "core/surface/extent.h"

namespace patchmill {
namespace {

class StageClock {
 public:
  explicit StageClock(std::vector<StageTime>& out) : out_(out), start_(std::chrono::steady_clock::now()) {}
  void Done(std::string name) {
    const auto now = std::chrono::steady_clock::now();
    out_.push_back({std::move(name), std::chrono::duration<double>(now - start_).count()});
    start_ = now;
  }

 private:
  std::vector<StageTime>& out_;
  std::chrono::steady_clock::time_point start_;
};

bool IsLimited(const OperationLimits& operation_limits) {
  return !operation_limits.WantsAll() || !operation_limits.AllowsAll();
}

// Keeps references to `surface` and `resolved`.
absl::StatusOr<OperationLimits> MakeOperationLimits(const Surface& surface, const Job& job,
                                                    const Resolved& resolved, const RunContext& run) {
  OperationLimitsParams p;
  p.ball_radius = resolved.radius;
  p.tool_radius = WidestRadius(job.operation.tool);
  p.leave = job.operation.leave;
  p.uppers = UpperCylindersOf(job.operation.tool);
  p.tolerance = job.operation.tolerance;
  return OperationLimits::Make(surface, resolved.containment, p, run);
}

RegionParams MakeRegionParams(const Job& job, const Resolved& resolved,
                              const OperationLimits* operation_limits) {
  RegionParams p;
  p.radius = resolved.plan_radius;
  p.tolerance = job.operation.tolerance;
  p.steep_angle = resolved.split_angle;
  p.floor_z = resolved.plan_floor_z - job.operation.leave;
  p.detail = job.operation.detail;
  p.operation_limits = operation_limits;
  p.finished = FinishedByForced(job.operation, resolved.plan_radius);
  return p;
}

absl::StatusOr<ChosenRegions> MakeRegions(const JobContext& context) {
  const auto& [surface, job, resolved, limits, run] = context;
  PM_ASSIGN_OR_RETURN(
      RegionMap map,
      SplitRegions(surface, MakeRegionParams(job, resolved, IsLimited(limits) ? &limits : nullptr), run));
  PM_ASSIGN_OR_RETURN(RegionChoices chosen,
                      ChooseRegions(surface, map, job.operation, resolved.program_zero));
  PM_ASSIGN_OR_RETURN(CircularChoices circular, ChooseCircularLines(context, map, std::move(chosen)));
  PM_ASSIGN_OR_RETURN(std::vector<RegionFigures> figures,
                      MeasureRegions(context, map, circular.regions.choices));
  return ChosenRegions{std::move(map), std::move(circular.regions), std::move(circular.trials),
                       std::move(figures)};
}

LinkParams MakeLinkParams(const Job& job, const Resolved& resolved, const OperationLimits* operation_limits) {
  LinkParams p;
  p.radius = resolved.radius;
  p.clearance_z = resolved.clearance_z;
  p.stock_top_z = resolved.stock_top_z;
  p.allowance = job.setup.allowance;
  // Whatever the operation says, rapids stay clear by more than rounding and the control's smoothing.
  p.approach_gap = std::max(job.operation.approach_gap, job.operation.tolerance);
  p.low_rapids = StockIsStated(job.setup) && !job.operation.high_rapids;
  p.stock = resolved.stock.get();
  p.depth_limit = resolved.depth_limit;
  p.tool_radius = WidestRadius(job.operation.tool);
  for (const UpperCylinder& cylinder : UpperCylindersOf(job.operation.tool)) {
    if (cylinder.part == UpperPart::kShank) {
      p.shank_lower = std::max(0.0, job.operation.leave - cylinder.rise);
    } else {
      p.holder.push_back(cylinder);
    }
  }
  p.feed = job.operation.tool.feed;
  p.plunge_feed = job.operation.tool.plunge_feed;
  p.contour_direction = job.operation.contour_direction;
  p.lead.radius = job.operation.lead_radius.value_or(0.5 * resolved.radius);
  p.lead.sweep = job.operation.lead_sweep;
  p.plunge_angle = job.operation.plunge_angle;
  p.link_feed = job.operation.link_feed;
  p.keep_feed = job.operation.keep_feed;
  p.lead_feed = job.operation.lead_feed;
  p.pass = MakePassParams(job, resolved);
  // No arcs are fitted to links, so they may use the share of arcs, too.
  p.pass.chord_tolerance = resolved.budget.chord + resolved.budget.arc;
  p.operation_limits = operation_limits;
  return p;
}

std::vector<std::string> Header(const Job& job, const Resolved& r, const Diagnostics& assumptions) {
  std::vector<std::string> lines = job.header;
  lines.push_back(fmt::format(
      "tolerance {:.4g} = chord {:.4g} + arc {:.4g} + rounding {:.4g} + certificate {:.4g} + control {:.4g}, "
      "scallop {:.4g}, "
      "leave {:.4g}",
      job.operation.tolerance, r.budget.chord, r.budget.arc, r.budget.rounding, r.budget.certificate,
      r.budget.controller, job.operation.scallop, job.operation.leave));
  const auto add = [&](bool to_check) {
    for (const Diagnostic& d : assumptions) {
      if (IsToCheckBeforeStart(d.code) == to_check) lines.push_back(fmt::format("{}: {}", d.code, d.message));
    }
  };
  add(false);
  if (std::any_of(assumptions.begin(), assumptions.end(),
                  [](const Diagnostic& d) { return IsToCheckBeforeStart(d.code); })) {
    lines.push_back("ASSUMED: check before start");
    add(true);
  }
  return lines;
}

// Corners of passes at their own feed, and the time that this takes.
void SlowCorners(const Operation& op, LinkResult& linked) {
  const double least = std::min(*op.corner_feed, op.tool.feed);
  CornerFeedResult slowed = WithCornerFeeds(std::move(linked.toolpath), {op.tool.feed, least});
  linked.toolpath = std::move(slowed.toolpath);
  linked.stats.corner_length = slowed.slowed_length;
  const std::vector<Move>& moves = linked.toolpath.moves;
  linked.stats.time = 0.0;
  for (std::size_t i = 1; i < moves.size(); ++i)
    linked.stats.time += EstimatedTime(moves[i], (moves[i].to - moves[i - 1].to).norm());
}

// The passes in their order, linked where the parts are cut.
absl::StatusOr<LinkResult> Link(const JobContext& context, const Locator& locator, const RegionMap& map,
                                const JobParts& parts, std::vector<CutterPath> paths) {
  std::optional<OperationLimits> within;
  if (parts.limits != nullptr) {
    if (auto cells = CutCells(map, parts.choices, parts.parts)) {
      PM_ASSIGN_OR_RETURN(within, parts.limits->Within(std::move(cells), context.run));
    }
  }
  const LinkParams params = MakeLinkParams(context.job, context.resolved, within ? &*within : parts.limits);
  PM_ASSIGN_OR_RETURN(LinkResult linked, LinkPaths(locator, map, std::move(paths), params, context.run));
  linked.toolpath = Straightened(std::move(linked.toolpath));
  if (context.job.operation.corner_feed) SlowCorners(context.job.operation, linked);
  return linked;
}

// Rad: as much steeper may an arc descend than the steepest move at cutting feed.
constexpr double kArcSteeper = Radians(0.25);

// The motion with fewer and longer moves: arcs where the control has them.
Toolpath Fitted(const Job& job, const Resolved& resolved, const LinkResult& motion) {
  const DialectArcs& arcs = job.dialect.arcs;
  ArcFit fit;
  fit.budget = resolved.budget.arc;
  fit.into_surface = 0.5 * resolved.budget.arc;
  if (job.arcs) fit.planes = arcs.planes;
  fit.helices = arcs.helices;
  fit.largest_radius = arcs.largest_radius;
  fit.plunge_feed = job.operation.tool.plunge_feed;
  fit.plunge_angle = job.operation.plunge_angle + kArcSteeper;
  // Rounding lowers an arc by a tick at most, kAboveLowest or more.
  fit.lowest = resolved.plan_floor_z + resolved.radius +
               std::max(0.0, 1.5 * TickOf(job.dialect, job.unit) - kAboveLowest);
  for (const CutterPath& pass : motion.passes) fit.straight_passes.push_back(pass.kind == PassKind::kRest);
  ArcFit leads = fit;
  leads.kind = MoveKind::kLead;
  leads.budget = kLeadSagitta * (resolved.budget.chord + resolved.budget.arc);
  return FitArcs(FitArcs(motion.toolpath, fit), leads);
}

// The choices with the quickest angles where they are open. Each of up to kQuickestAnglePlans plans costs as
// much as the whole job.
absl::StatusOr<std::vector<RegionChoice>> WithQuickestAngles(const JobContext& context,
                                                             const Locator& locator,
                                                             const ChosenRegions& regions) {
  const RegionMap& map = regions.map;
  const auto time = [&](const std::vector<RegionChoice>& choices) -> absl::StatusOr<RegionTimes> {
    const JobParts tried = PartsOfJob(context, map, choices);
    PM_ASSIGN_OR_RETURN(PlannedPasses passes, PlanPasses(context, locator, map, tried));
    PM_ASSIGN_OR_RETURN(const LinkResult motion, Link(context, locator, map, tried, std::move(passes.paths)));
    return TimesOf(motion, map.regions.size());
  };
  return QuickestAngles(map, regions.chosen, regions.trials, time);
}

// Ends a job that is far above the limit before its passes are made: the lines and levels that they are made
// from would fill the memory. LeastCutLength counts patches that overlap in part once each, although they are
// milled once; hence far above.
absl::Status CheckLeastFeed(const PathLimits& limits, double least_cut_length) {
  constexpr double kFarAbove = 10.0;
  if (!(least_cut_length > kFarAbove * limits.length)) return absl::OkStatus();
  return LimitPassedError(
      {"cut_length_mm", limits.length, least_cut_length},
      "that is what the passes of this finish come to; raise the scallop or the tool's diameter, or "
      "cut the part in pieces (selection)");
}

// A program has the points and the feed of its links too.
absl::Status CheckMotion(const PathLimits& limits, const LinkResult& linked) {
  return CheckAmount(
      limits,
      {linked.stats.cut_length + linked.stats.link_length, static_cast<double>(linked.toolpath.moves.size())},
      "with their links");
}

// The feed moves of the ball's centre.
std::vector<PathSegment> FeedsOf(const Toolpath& toolpath) {
  std::vector<PathSegment> feeds;
  for (std::size_t i = 1; i < toolpath.moves.size(); ++i) {
    if (toolpath.moves[i].kind == MoveKind::kRapid) continue;
    feeds.push_back({toolpath.moves[i - 1].to, toolpath.moves[i].to, static_cast<int>(i)});
  }
  return feeds;
}

}  // namespace

absl::StatusOr<ChosenRegions> PlanRegions(const Surface& surface, const Job& job, const RunContext& run) {
  PM_RETURN_IF_ERROR(ValidateJob(job));
  PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(surface, job, run));
  PM_ASSIGN_OR_RETURN(const OperationLimits operation_limits,
                      MakeOperationLimits(surface, job, resolved, run));
  const JobContext context{surface, job, resolved, operation_limits, run};
  PM_ASSIGN_OR_RETURN(ChosenRegions regions, MakeRegions(context));
  PM_ASSIGN_OR_RETURN(regions.map, MarkUnfinishedByStrategy(context, std::move(regions.map), regions.chosen));
  return regions;
}

absl::StatusOr<std::vector<PlanPart>> VerifiedParts(const Surface& surface, const Job& job,
                                                    const Resolved& resolved, const RunContext& run) {
  if (job.operation.overrides.empty()) return std::vector<PlanPart>();
  PM_ASSIGN_OR_RETURN(const OperationLimits operation_limits,
                      MakeOperationLimits(surface, job, resolved, run));
  PM_ASSIGN_OR_RETURN(const ChosenRegions regions,
                      MakeRegions({surface, job, resolved, operation_limits, run}));
  return PartsOf(regions.map, regions.chosen.choices);
}

namespace {

// The line of a program that a message of its reader names ("line 34: ..."), as " in the line "G1 X3"";
// empty if it names none. The program itself is written nowhere.
std::string NamedLine(std::string_view text, std::string_view message) {
  int number = 0;
  constexpr std::string_view kLine = "line ";
  if (message.substr(0, kLine.size()) != kLine) return "";
  if (!absl::SimpleAtoi(std::string(message.substr(kLine.size(), message.find(':') - kLine.size())), &number))
    return "";
  for (int line = 1; line < number; ++line) TakeLine(text);
  return fmt::format(" in \"{}\"", TakeLine(text).substr(0, 80));
}

// A post file of the user's own may write what the reader does not know.
absl::Status CannotReadBack(const Dialect& dialect, std::string_view text, const absl::Status& status) {
  if (status.code() != absl::StatusCode::kInvalidArgument) return status;
  const std::string message(status.message());
  return FieldError(
      "post.post_file",
      fmt::format("of the dialect {}: the program cannot be read back, so it cannot be verified: {}{}; "
                  "[words] of the post file says what a word of the control does",
                  dialect.name, message, NamedLine(text, message)));
}

bool HasArcs(const Toolpath& toolpath) {
  return std::any_of(toolpath.moves.begin(), toolpath.moves.end(),
                     [](const Move& move) { return move.arc.has_value(); });
}

// The text of a program, and what the verifier says of it.
struct VerifiedProgram {
  WrittenProgram written;
  VerifyReport report;
};

// The chords of arcs are a tenth as far from the arc as maxima are certain.
absl::StatusOr<VerifiedProgram> PostAndVerify(const JobContext& context, const Toolpath& toolpath,
                                              const PostParams& post, const VerifyParams& verify,
                                              std::size_t most_moves) {
  const Job& job = context.job;
  VerifiedProgram program;
  PM_ASSIGN_OR_RETURN(program.written, WriteProgramWithLines(toolpath, job.operation.tool, post));
  const auto read = ReadProgram(program.written.text, {.arc_chord_error = 0.1 * verify.certainty,
                                                       .max_moves = most_moves,
                                                       .run = &context.run,
                                                       .dialect = job.dialect,
                                                       .control_deviation = job.control_deviation});
  if (!read.ok()) return CannotReadBack(job.dialect, program.written.text, read.status());
  PM_ASSIGN_OR_RETURN(program.report,
                      Verify(context.surface, job.operation.tool, *read, verify, context.run));
  PM_ASSIGN_OR_RETURN(const Diagnostics faults, CheckPosted(program.written, *read, job, context.run));
  program.report.findings.insert(program.report.findings.begin(), faults.begin(), faults.end());
  program.report.motion_ok = program.report.motion_ok && faults.empty();
  return program;
}

// The rules by which LinuxCNC drives the program; absent for other controls.
std::optional<LinuxCncPlanner> PlannerOf(const Job& job, const Resolved& resolved) {
  if (!job.dialect.linuxcnc_planner) return std::nullopt;
  const bool stated =
      !job.dialect.path_tolerance.empty() && resolved.budget.controller >= job.dialect.least_tolerance;
  return LinuxCncPlanner{.tolerance = stated ? resolved.budget.controller : 0.0,
                         .step = TickOf(job.dialect, job.unit)};
}

absl::StatusOr<JobResult> PlanAndJudge(const Surface& surface, const Job& job, const Resolved& resolved,
                                       const RunContext& run) {
  PM_RETURN_IF_ERROR(ValidateJob(job));
  JobResult result;
  JobReport& report = result.report;
  StageClock clock(report.stages);
  result.program_zero = resolved.program_zero;
  report.controller_tolerance = resolved.budget.controller;
  report.diagnostics = Assumptions(job, resolved);
  const Diagnostics assumptions = report.diagnostics;
  const Diagnostics idle = UnusedSettings(job.operation);

  PM_ASSIGN_OR_RETURN(const ModelCheck check,
                      CheckModel(surface, job.operation.tool, ReachTolerance(job.operation.tolerance), run));
  report.min_concave_radius = check.min_concave_radius;
  for (const Diagnostics* findings : {&idle, &job.model_remarks, &check.findings}) {
    report.diagnostics.insert(report.diagnostics.end(), findings->begin(), findings->end());
  }
  clock.Done("check");

  PM_ASSIGN_OR_RETURN(const OperationLimits operation_limits,
                      MakeOperationLimits(surface, job, resolved, run));
  const JobContext context{surface, job, resolved, operation_limits, run};
  PM_ASSIGN_OR_RETURN(ChosenRegions regions, MakeRegions(context));
  clock.Done("regions");

  PM_ASSIGN_OR_RETURN(const Locator locator, Locator::Make(surface, resolved.plan_radius, run));
  PM_ASSIGN_OR_RETURN(report.least_cut_length,
                      LeastCutLength(context, locator, regions.map, regions.chosen.choices));
  PM_RETURN_IF_ERROR(CheckLeastFeed(job.path_limits, report.least_cut_length));
  if (job.operation.angle_auto) {
    PM_ASSIGN_OR_RETURN(std::vector<RegionChoice> quickest, WithQuickestAngles(context, locator, regions));
    PM_ASSIGN_OR_RETURN(regions.figures, MeasureRegions(context, regions.map, quickest));
    regions.chosen = {std::move(quickest), std::vector<OpenChoice>(regions.map.regions.size())};
    clock.Done("angles");
  }
  report.choices = regions.chosen.choices;
  report.figures = regions.figures;
  PM_ASSIGN_OR_RETURN(result.regions,
                      MarkUnfinishedByStrategy(context, std::move(regions.map), regions.chosen));
  report.regions = result.regions.regions;
  const JobParts parts = PartsOfJob(context, result.regions, report.choices);
  PM_ASSIGN_OR_RETURN(PlannedPasses planned, PlanPasses(context, locator, result.regions, parts));
  report.diagnostics.insert(report.diagnostics.end(), planned.findings.begin(), planned.findings.end());
  const bool reported = std::any_of(idle.begin(), idle.end(),
                                    [](const Diagnostic& d) { return d.where.field == "contour_spirals"; });
  if (!reported) {
    const Diagnostics more = UnusedSpirals(job.operation, planned.paths);
    report.diagnostics.insert(report.diagnostics.end(), more.begin(), more.end());
  }
  report.certificate_defects = locator.defect_count();
  clock.Done("passes");
  const auto nothing = [&](double reached) -> JobResult&& {
    report.outcome = Outcome::kNothingToCut;
    report.diagnostics.push_back(NothingToCut(report, resolved, parts.limits != nullptr, reached));
    report.motion = {};
    report.point_count = 0;
    result.motion = {};
    result.posted = {};
    return std::move(result);
  };
  if (planned.paths.empty()) return nothing(0.0);

  PM_ASSIGN_OR_RETURN(result.motion, Link(context, locator, result.regions, parts, std::move(planned.paths)));
  PM_RETURN_IF_ERROR(CheckMotion(job.path_limits, result.motion));
  report.motion = result.motion.stats;
  const auto post_as = [&](Toolpath posted) {
    report.point_count = static_cast<int>(posted.moves.size());
    result.posted_seconds = SecondsOf(posted, job.setup.machine, PlannerOf(job, resolved));
    if (job.setup.machine)
      report.times = SumsOf(posted, result.posted_seconds, result.regions.regions.size());
    result.posted = std::move(posted);
  };
  post_as(Fitted(job, resolved, result.motion));
  PM_ASSIGN_OR_RETURN(const Diagnostics beside,
                      FindToolBesidePart(surface, TipsOf(result.motion.toolpath), resolved.radius,
                                         resolved.program_zero, run));
  report.diagnostics.insert(report.diagnostics.end(), beside.begin(), beside.end());
  clock.Done("link");
  report.leads = result.motion.leads;
  const Diagnostics steep = SteepLeads(report.leads, resolved);
  report.diagnostics.insert(report.diagnostics.end(), steep.begin(), steep.end());
  if (resolved.stock != nullptr) {
    const DeepCuts deep = FindDeepCuts(*resolved.stock, FeedsOf(result.motion.toolpath), resolved.radius,
                                       resolved.depth_limit, run);
    PM_RETURN_IF_ERROR(run.Check());
    if (deep.move >= 0) {
      report.outcome = Outcome::kNeedsRoughing;
      report.diagnostics.push_back(NeedsRoughing(deep, job, resolved));
      return result;
    }
  }

  PostParams post;
  post.dialect = job.dialect;
  if (job.line_number_step) post.dialect.line_number_step = *job.line_number_step;
  post.unit = job.unit;
  post.program_number = job.program_number;
  post.work_offset = job.work_offset;
  post.program_zero = resolved.program_zero;
  post.zero_name = resolved.zero_name;
  post.controller_tolerance = resolved.budget.controller;
  post.clearance_z = resolved.clearance_z;
  post.chord_sagitta = 0.5 * resolved.budget.rounding;
  Diagnostics head = assumptions;
  head.insert(head.end(), beside.begin(), beside.end());
  post.header = Header(job, resolved, head);
  post.restart_points = job.restart_points;
  post.sections = SectionsOf(result.posted, result.motion, result.regions, resolved.program_zero);
  if (job.restart_points && std::none_of(post.sections.begin(), post.sections.end(),
                                         [](const ProgramSection& section) { return section.restart; })) {
    report.diagnostics.push_back(MakeWarning(
        "NO_RESTART_POINTS",
        "the tool is nowhere retracted before a section, so the program has no restart points; it "
        "is with rapids at the clearance plane (--high-rapids)"));
  }
  const VerifyParams verify = MakeVerifyParams(job, resolved, parts.parts);
  // As many moves as were written: CheckMotion has bounded them.
  const std::size_t most_moves = MostMovesOf(result.motion);
  PM_ASSIGN_OR_RETURN(VerifiedProgram program,
                      PostAndVerify(context, result.posted, post, verify, most_moves));
  clock.Done("verify");
  if (!program.report.ok() && HasArcs(result.posted)) {
    post.sections = SectionsOf(result.motion.toolpath, result.motion, result.regions, resolved.program_zero);
    PM_ASSIGN_OR_RETURN(VerifiedProgram straight,
                        PostAndVerify(context, result.motion.toolpath, post, verify, most_moves));
    clock.Done("verify without arcs");
    if (straight.report.ok()) {
      report.diagnostics.push_back(MakeWarning(
          "ARCS_LEFT_OUT", "with arcs a promise would be broken, so the program has straight moves only"));
      program = std::move(straight);
      post_as(result.motion.toolpath);
    }
  }
  report.verify = std::move(program.report);
  if (report.verify.NothingToFinish()) return nothing(report.verify.reachable_area);
  const std::optional<double>& stickout = job.operation.tool.stickout;
  if (stickout && job.operation.tool.holder.empty() && *stickout < report.verify.required_stickout) {
    report.diagnostics.push_back(MakeWarning(
        "STICKOUT_TOO_SHORT",
        fmt::format(
            "tool.stickout_mm = {:.4g}; material may stand {:.4g} mm above the tip, where the holder is",
            *stickout, report.verify.required_stickout)));
  }
  report.diagnostics.insert(report.diagnostics.end(), report.verify.findings.begin(),
                            report.verify.findings.end());
  if (!report.verify.ok()) {
    report.outcome = Outcome::kVerificationFailed;
    return result;
  }
  const double unreached = UnreachedShare(report.verify, job.operation);
  if (unreached > job.operation.max_unreached) {
    report.outcome = Outcome::kTooMuchUnreached;
    report.diagnostics.push_back(TooMuchUnreached(report.verify, job.operation, unreached));
    return result;
  }
  double unreachable = 0.0;
  for (const double area : report.verify.unreachable_area) unreachable += area;
  report.outcome = unreachable > 0.0 ? Outcome::kCompleteWhereReachable : Outcome::kComplete;
  result.program = std::move(program.written.text);
  result.posted_lines = std::move(program.written.move_lines);
  return result;
}

}  // namespace

std::size_t MostMovesOf(const LinkResult& motion) {
  return std::max(ReaderParams().max_moves, 20 * motion.toolpath.moves.size());
}

absl::StatusOr<VerifyReport> VerifyProgramText(const Surface& surface, const Tool& tool,
                                               std::string_view text, const VerifyParams& params,
                                               const RunContext& run) {
  PM_ASSIGN_OR_RETURN(const ProgramMotion motion, ReadProgram(text, {.run = &run}));
  return Verify(surface, tool, motion, params, run);
}

absl::StatusOr<JobResult> RunJob(const Surface& surface, const Job& job, const RunContext& run) {
  PM_RETURN_IF_ERROR(ValidateJob(job));
  const PolledRun polled(run);
  PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(surface, job, run));
  return RunJob(surface, job, resolved, run);
}

absl::StatusOr<JobResult> RunJob(const Surface& surface, const Job& job, const Resolved& resolved,
                                 const RunContext& run) {
  const PolledRun polled(run);
  absl::StatusOr<JobResult> result = PlanAndJudge(surface, job, resolved, run);
  PM_RETURN_IF_ERROR(run.Check());
  return result;
}

}  // namespace patchmill
