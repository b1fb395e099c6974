#include "cam/verify/verify.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/limits/upper_cylinders.h"
#include "cam/verify/broken_limits.h"
#include "cam/verify/gouge.h"
#include "cam/verify/leftover.h"
#include "cam/verify/leftover_map.h"
#include "cam/verify/leftover_spread.h"
#include "cam/verify/machine_limits.h"
#include "cam/verify/motion_figures.h"
#include "cam/verify/motion_rules.h"
#include "cam/verify/motion_sets.h"
#include "cam/verify/stock_moves.h"
#include "cam/verify/validate.h"
#include "cam/verify/verify_limits.h"
#include "core/base/polled_run.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

constexpr std::size_t kMostFindings = 20;  // per code
constexpr double kRapidSlack = 1e-3;       // mm; rounding and the certainty of planned heights

class Verifier {
 public:
  Verifier(const Surface& surface, const Tool& tool, const ProgramMotion& motion, const VerifyParams& params,
           const RunContext& run)
      : surface_(surface), tool_(tool), motion_(motion), params_(params), run_(run) {
    ball_ = BallRadius(tool);
    radius_ = ball_ + params.leave;
  }

  absl::StatusOr<VerifyReport> Run() {
    offset_ = params_.program_zero + Vec3(0, 0, ball_);
    chord_error_ = ChordError(motion_);
    // Cells are fine enough for areas and no wider than R, but there are not much more than 400,000 of them.
    const double area = RoughArea(surface_);
    const double size = std::clamp(std::sqrt(area / 9e3), 0.02 * radius_, radius_);
    roots_ = RootCells(surface_, std::max(size, std::sqrt(area / 4e5)), run_);
    PM_RETURN_IF_ERROR(run_.Check());
    PM_ASSIGN_OR_RETURN(limits_, VerifyLimits::Make(surface_, tool_, params_, run_));
    wanted_ = limits_->Wanted(roots_);
    PM_RETURN_IF_ERROR(JudgeGouge());
    PM_RETURN_IF_ERROR(JudgeFinish());
    PM_RETURN_IF_ERROR(JudgeMotion());
    JudgeHolder();
    run_.Progress("verify", 1.0);
    return std::move(report_);
  }

 private:
  int Line(int move) const { return move < 0 ? 0 : motion_.moves[static_cast<std::size_t>(move)].line; }

  VerifyPlace Place(const Extreme& e) const {
    VerifyPlace place;
    if (e.value <= 0.0) return place;
    place.point = e.point;
    const PatchId patch = surface_.piece(e.piece).patch;
    const Where where = WhereOf(surface_.network.model, patch);
    place.patch_index = patch.value;
    place.patch_id = where.patch_id;
    place.face_id = where.face_id;
    place.line = Line(e.move);
    return place;
  }

  void Report(const std::string& code, const std::string& message) {
    Diagnostic d;
    d.code = code;
    d.severity = Severity::kError;
    d.message = message;
    report_.findings.push_back(std::move(d));
  }

  // Reports the worst ones. Of several with the same line or within one radius only the worst is reported.
  void ReportPlaces(const std::string& code, const std::vector<Extreme>& found, const std::string& what) {
    std::vector<const Extreme*> kept;
    for (const Extreme& e : found) {
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const Extreme* k) {
        return Line(k->move) == Line(e.move) || (k->point - e.point).norm() < radius_;
      });
      if (known) continue;
      if (kept.size() >= kMostFindings) {
        Report("MORE_FINDINGS", fmt::format("{} at more places than the {} listed", code, kMostFindings));
        report_.findings.back().severity = Severity::kInfo;
        break;
      }
      kept.push_back(&e);
      const VerifyPlace place = Place(e);
      Report(code,
             fmt::format("line {}: {} by {:.4f} mm at X{:.4f} Y{:.4f} Z{:.4f}", place.line, what, e.value,
                         e.point.x() - params_.program_zero.x(), e.point.y() - params_.program_zero.y(),
                         e.point.z() - params_.program_zero.z()));
      Where& where = report_.findings.back().where;
      where.patch_id = place.patch_id;
      where.face_id = place.face_id;
      where.patch_index = place.patch_index;
      where.point = e.point;
      where.line = place.line;
    }
  }

  // Checks that all moves keep their distance from avoided patches.
  absl::Status JudgeAvoided() {
    const Surface* avoided = limits_->centers().avoided;
    if (avoided == nullptr) return absl::OkStatus();
    GougeParams p;
    p.radius = limits_->centers().avoid_distance;
    p.chord_error = chord_error_;
    p.certainty = params_.certainty;
    p.limit = std::max(0.0, params_.tolerance - motion_.controller_tolerance);
    const SegmentTree tree(CollectMoves(motion_, MotionSet::kSwept, offset_), Metric::kSwept, radius_, run_);
    PM_RETURN_IF_ERROR(JudgeAvoidedBy(tree, p, "the tool comes too near to an avoided patch"));
    const SegmentTree boxes(CollectMoves(motion_, MotionSet::kDogLegs, offset_), Metric::kSweptBox, radius_,
                            run_);
    PM_RETURN_IF_ERROR(JudgeAvoidedBy(boxes, p,
                                      "not driving all axes together, a control may take a rapid too "
                                      "near to an avoided patch"));
    // Everything within the margin of a cylinder lies in a cylinder that is wider and begins lower by the
    // margin.
    const double margin = params_.containment.avoid_margin;
    for (const UpperCylinder& cylinder : UppersThatMayTouch(*avoided, margin)) {
      const char* part = Name(cylinder.part);
      p.radius = cylinder.radius + margin;
      const Vec3 up(0, 0, cylinder.rise - margin);
      const SegmentTree swept(CollectMoves(motion_, MotionSet::kSwept, offset_ + up), Metric::kShank, radius_,
                              run_, p.radius);
      const std::size_t before = report_.findings.size();
      PM_RETURN_IF_ERROR(
          JudgeAvoidedBy(swept, p, fmt::format("the {} comes too near to an avoided patch", part)));
      const SegmentTree any_way(CollectMoves(motion_, MotionSet::kDogLegs, offset_ + up), Metric::kShankBox,
                                radius_, run_, p.radius);
      PM_RETURN_IF_ERROR(JudgeAvoidedBy(
          any_way, p,
          fmt::format("not driving all axes together, a control may take the {} of a rapid too near to an "
                      "avoided patch",
                      part)));
      if (cylinder.part == UpperPart::kHolder && report_.findings.size() > before) holder_may_hit_ = true;
    }
    return absl::OkStatus();
  }
  absl::Status JudgeAvoidedBy(const SegmentTree& tree, const GougeParams& p, const std::string& text) {
    const Surface& avoided = *limits_->centers().avoided;
    const std::vector<CellRect> roots = RootCells(avoided, radius_, run_);
    PM_ASSIGN_OR_RETURN(Extremes found,
                        FindGouge({avoided, roots}, tree, p, run_, "verify: avoided patches"));
    if (!found.violations.empty()) report_.motion_ok = false;
    for (Extreme& e : found.violations) e.piece = limits_->PieceOfWhole(e.piece);
    ReportPlaces("AVOID_MARGIN", found.violations, text);
    return absl::OkStatus();
  }

  absl::Status JudgeGouge() {
    GougeParams p;
    p.radius = radius_;
    p.chord_error = chord_error_;
    p.certainty = params_.certainty;
    // The control's own smoothing may deepen each gouge [verification P1].
    const double smoothing = motion_.controller_tolerance;
    const bool bounded = std::isfinite(smoothing);
    // Without a bound every place could be gouged. Then the path as it is programmed is judged.
    p.limit = bounded ? std::max(0.0, params_.tolerance - smoothing) : params_.tolerance;
    if (!bounded) {
      Report("CONTROL_SMOOTHING",
             "no word says how far the control may leave the path, so nothing bounds its gouges: state a "
             "tolerance or exact stop in the program, in the words of the control, or how far the control "
             "leaves the path (--control-deviation)");
    }
    const SegmentTree tree(CollectMoves(motion_, MotionSet::kSwept, offset_), Metric::kSwept, radius_, run_);
    PM_ASSIGN_OR_RETURN(const Extremes gouge, FindGouge({surface_, roots_}, tree, p, run_, "verify: gouge"));
    report_.max_gouge = gouge.worst.value;
    report_.max_gouge_at = Place(gouge.worst);
    ReportPlaces("GOUGE", gouge.violations, "the ball or the shank above it cuts into the surface");
    PM_RETURN_IF_ERROR(JudgeUppers(p));
    report_.gouge_ok = report_.max_gouge + smoothing <= params_.tolerance;
    if (bounded && !report_.gouge_ok && report_.max_gouge <= params_.tolerance) {
      Report(
          "CONTROL_SMOOTHING",
          fmt::format("gouge {:.4f} mm and the control's smoothing {:.4f} mm together exceed the tolerance "
                      "{:.4f} mm",
                      report_.max_gouge, smoothing, params_.tolerance));
    }
    return JudgeSmoothedRapids();
  }

  // Rapids may be smoothed more than feeds if they are that much farther from the surface.
  absl::Status JudgeSmoothedRapids() {
    const double smoothing = motion_.rapid_tolerance;
    if (smoothing <= motion_.controller_tolerance) return absl::OkStatus();
    if (!std::isfinite(smoothing)) {
      report_.gouge_ok = false;
      Report("CONTROL_SMOOTHING", "no word says how far rapids may leave their path: it is not bounded");
      return absl::OkStatus();
    }
    GougeParams p;
    p.radius = radius_ + smoothing;
    p.certainty = params_.certainty;
    p.limit = params_.tolerance;
    const SegmentTree tree(CollectMoves(motion_, MotionSet::kSweptRapids, offset_), Metric::kSwept, radius_,
                           run_);
    PM_ASSIGN_OR_RETURN(const Extremes gouge, FindGouge({surface_, roots_}, tree, p, run_, "verify: rapids"));
    if (gouge.worst.value > params_.tolerance) report_.gouge_ok = false;
    ReportPlaces("CONTROL_SMOOTHING", gouge.violations,
                 "a rapid, smoothed by the control, cuts into the surface");
    return absl::OkStatus();
  }

  // The cylinders of the tool above the ball that come so low, somewhere, that they may touch `surface` with
  // this margin (mm).
  std::vector<UpperCylinder> UppersThatMayTouch(const Surface& surface, double margin) const {
    double lowest = kInfinity;  // centre
    for (const PathSegment& move : CollectMoves(motion_, MotionSet::kSwept, offset_))
      lowest = std::min({lowest, move.a.z(), move.b.z()});
    std::vector<UpperCylinder> cylinders = UpperCylindersOf(tool_);
    std::erase_if(cylinders, [&](const UpperCylinder& cylinder) {
      return lowest + cylinder.rise - margin > surface.box.max.z();
    });
    return cylinders;
  }

  absl::Status JudgeUppers(GougeParams p) {
    for (const UpperCylinder& cylinder : UppersThatMayTouch(surface_, params_.leave)) {
      const char* part = Name(cylinder.part);
      const Vec3 up(0, 0, cylinder.rise);
      p.radius = cylinder.radius + params_.leave;
      const SegmentTree tree(CollectMoves(motion_, MotionSet::kSwept, offset_ + up), Metric::kShank, radius_,
                             run_, cylinder.radius);
      PM_ASSIGN_OR_RETURN(const Extremes found,
                          FindGouge({surface_, roots_}, tree, p, run_, "verify: shank and holder"));
      if (found.worst.value > report_.max_gouge) {
        report_.max_gouge = found.worst.value;
        report_.max_gouge_at = Place(found.worst);
      }
      ReportPlaces(cylinder.part == UpperPart::kShank ? "SHANK_GOUGE" : "HOLDER_GOUGE", found.violations,
                   fmt::format("the {} stands in the surface", part));
      const SegmentTree boxes(OtherDogLegs(found, offset_ + up), Metric::kShankBox, radius_, run_,
                              cylinder.radius);
      PM_ASSIGN_OR_RETURN(const Extremes beside,
                          FindGouge({surface_, roots_}, boxes, p, run_, "verify: shank and holder"));
      if (!beside.violations.empty()) {
        upper_part_may_hit_ = true;
        if (cylinder.part == UpperPart::kHolder) holder_may_hit_ = true;
      }
      ReportPlaces("RAPID_DOG_LEG", beside.violations,
                   fmt::format("a control that does not drive all axes together may take the {} of a rapid "
                               "into the surface",
                               part));
    }
    return absl::OkStatus();
  }

  // After all else: what the findings say of the holder.
  void JudgeHolder() {
    if (tool_.holder.empty()) return;
    report_.holder_ok = !holder_may_hit_ && std::none_of(report_.findings.begin(), report_.findings.end(),
                                                         [](const Diagnostic& d) {
                                                           return d.code.compare(0, 7, "HOLDER_") == 0;
                                                         });
  }

  absl::Status JudgeFinish() {
    const SegmentTree tree(
        OutsideOfMaterial(limits_->centers(), CollectMoves(motion_, MotionSet::kCut, offset_)), Metric::kPath,
        radius_, run_);
    report_.finish_ok = true;
    if (params_.parts.empty()) {
      FinishPart all;
      all.finish = params_.finish;
      return JudgePart(tree, all);
    }
    for (const FinishPart& part : params_.parts) PM_RETURN_IF_ERROR(JudgePart(tree, part));
    return absl::OkStatus();
  }

  absl::Status JudgePart(const SegmentTree& tree, const FinishPart& part) {
    LeftoverParams p;
    p.finish = part.finish;
    p.reach = {radius_, ReachTolerance(params_.tolerance), params_.floor_z + ball_, limits_->centers()};
    p.chord_error = chord_error_;
    p.certainty = params_.certainty;
    p.where = part.where.get();
    if (part.finish.scallop) p.limit = *part.finish.scallop + params_.tolerance;
    p.min_step_fraction = params_.min_step_fraction;
    p.most = surface_.box.Diagonal();
    std::vector<CellRect> cells = wanted_;
    if (p.where != nullptr) {
      std::erase_if(cells,
                    [&](const CellRect& c) { return !p.where->HasAny(c.piece, c.u0, c.u1, c.v0, c.v1); });
    }
    PM_ASSIGN_OR_RETURN(const AreaReport areas, MeasureAreas({surface_, cells}, tree, p, run_));
    TakeAreas(areas);
    if (params_.sample_leftover) {
      PM_ASSIGN_OR_RETURN(const std::vector<LeftoverSample> samples,
                          SampleLeftover({surface_, cells}, tree, p, run_));
      for (const LeftoverSample& sample : samples) {
        report_.leftover_map.push_back(
            {sample.at.p, sample.corners, surface_.piece(sample.at.piece).patch.value, sample.leftover});
      }
    }
    if (part.finish.scallop) {
      const double square = 4.0 * *part.finish.scallop * (2.0 * radius_ - *part.finish.scallop);
      report_.reachable_squares = report_.reachable_squares.value_or(0.0) + ReachableOf(areas) / square;
      PM_ASSIGN_OR_RETURN(const LeftoverSpread spread, MeasureSpread({surface_, cells}, tree, p, run_));
      for (std::size_t k = 0; k < kLeftoverClasses; ++k) report_.leftover_area[k] += spread[k];
    }
    const Extreme& done = areas.deepest[FinishClass::kDone];
    const Extreme& above = areas.deepest[FinishClass::kAboveLimit];
    PM_ASSIGN_OR_RETURN(const Extremes left, FindLeftover({surface_, cells}, tree, p,
                                                          above.value > done.value ? above : done, run_));
    if (left.worst.value > report_.max_leftover) {
      report_.max_leftover = left.worst.value;
      report_.max_leftover_at = Place(left.worst);
    }
    if (part.finish.scallop && left.worst.value > p.limit) {
      report_.finish_ok = false;
      std::vector<Extreme> places = left.violations;
      places.insert(places.begin(), left.worst);
      ReportPlaces("LEFTOVER", places,
                   fmt::format("reachable material (limit {:.4g} mm) is left standing", p.limit));
    }
    return absl::OkStatus();
  }

  static double ReachableOf(const AreaReport& areas) {
    return areas.area[FinishClass::kDone] + areas.area[FinishClass::kAboveLimit];
  }

  void TakeAreas(const AreaReport& areas) {
    const auto take = [&](FinishClass kind, UncutReason reason) {
      report_.unreachable_area[reason] += areas.area[kind];
      report_.unreachable_plan_area[reason] += areas.plan_area[kind];
      const Extreme& deepest = areas.deepest[kind];
      if (deepest.value <= report_.deepest_unreachable[reason]) return;
      report_.deepest_unreachable[reason] = deepest.value;
      report_.deepest_unreachable_at[reason] = Place(deepest);
    };
    take(FinishClass::kUndercut, UncutReason::kUndercut);
    take(FinishClass::kConcave, UncutReason::kConcave);
    take(FinishClass::kFloor, UncutReason::kFloor);
    take(FinishClass::kAvoided, UncutReason::kAvoided);
    take(FinishClass::kStrategy, UncutReason::kStrategy);
    take(FinishClass::kShank, UncutReason::kShank);
    take(FinishClass::kHolder, UncutReason::kHolder);
    take(FinishClass::kOutside, UncutReason::kOutside);
    if (std::isfinite(areas.lowest_center)) {
      const double floor_z = std::floor((areas.lowest_center - ball_) * 1e3) / 1e3;
      report_.finishing_floor_z = std::min(report_.finishing_floor_z.value_or(kInfinity), floor_z);
    }
    // Beside a wall the ball may stand lower by the reach tolerance.
    const auto finishing = [&](UpperPart part, double length, std::optional<double>& out) {
      if (!(areas.raise[part] > 0.0)) return;
      const double needed = length + areas.raise[part] + ReachTolerance(params_.tolerance);
      out = std::max(out.value_or(0.0), std::ceil(needed * 1e3) / 1e3);
    };
    finishing(UpperPart::kShank, tool_.flute_length.value_or(0.0), report_.finishing_flute_length);
    finishing(UpperPart::kHolder, tool_.stickout.value_or(0.0), report_.finishing_stickout);
    for (const FinishClass kind : Enumerators<FinishClass>()) {
      if (kind != FinishClass::kUnwanted && kind != FinishClass::kUnderside)
        report_.total_area += areas.area[kind];
    }
    report_.underside_area += areas.area[FinishClass::kUnderside];
    report_.reachable_area += ReachableOf(areas);
    report_.reachable_plan_area +=
        areas.plan_area[FinishClass::kDone] + areas.plan_area[FinishClass::kAboveLimit];
    report_.leftover_above_limit_area += areas.area[FinishClass::kAboveLimit];
  }

  absl::Status JudgeMotion() {
    report_.motion_ok = !upper_part_may_hit_;
    PM_RETURN_IF_ERROR(JudgeRapids());
    const MotionFigures figures = MeasureMotion(motion_, tool_);
    report_.tip_box = figures.tip_box;
    report_.cut_length = figures.cut_length;
    report_.rapid_length = figures.rapid_length;
    report_.feed_blocks = figures.feed_blocks;
    report_.arc_blocks = figures.arc_blocks;
    report_.steepest_descent = figures.steepest_descent;
    if (!figures.tip_box.Empty()) report_.tip_z_min = figures.tip_box.min.z();
    PM_ASSIGN_OR_RETURN(report_.required_stickout, RequiredStickout(surface_, tool_, motion_, params_, run_));
    PM_RETURN_IF_ERROR(JudgeAvoided());
    Diagnostics broken = BrokenMotionRules(motion_, params_, figures);
    PM_RETURN_IF_ERROR(JudgeDescents(figures));
    if (params_.machine) {
      const Diagnostics beyond_machine = BeyondMachine(motion_, *params_.machine);
      broken.insert(broken.end(), beyond_machine.begin(), beyond_machine.end());
    }
    const double slack = std::max(0.0, params_.tolerance - motion_.controller_tolerance);
    const Diagnostics beyond =
        BrokenLimits(surface_, motion_, {limits_->centers(), radius_, offset_, slack}, run_);
    PM_RETURN_IF_ERROR(run_.Check());
    broken.insert(broken.end(), beyond.begin(), beyond.end());
    if (!broken.empty()) report_.motion_ok = false;
    report_.findings.insert(report_.findings.end(), broken.begin(), broken.end());
    report_.findings.insert(report_.findings.end(), motion_.assumptions.begin(), motion_.assumptions.end());
    if (tool_.plunge_feed <= 0.0 && figures.steepest_descent > kSteepDescent) {
      Diagnostic d;
      d.code = "PLUNGE_FEED_NOT_CHECKED";
      d.severity = Severity::kWarning;
      d.message = "the plunge feed is not known: feeds of descents steeper than 30 degrees are not judged";
      report_.findings.push_back(std::move(d));
    }
    return absl::OkStatus();
  }

  // The dog-legs of the moves that have no violation in `found`.
  std::vector<PathSegment> OtherDogLegs(const Extremes& found, const Vec3& offset,
                                        double clear_z = kInfinity) const {
    std::vector<bool> known(motion_.moves.size(), false);
    for (const Extreme& e : found.violations) known[static_cast<std::size_t>(e.move)] = true;
    std::vector<PathSegment> dog_legs = CollectMoves(motion_, MotionSet::kDogLegs, offset, clear_z);
    std::erase_if(dog_legs, [&](const PathSegment& s) { return known[static_cast<std::size_t>(s.move)]; });
    return dog_legs;
  }

  absl::Status JudgeRapids() {
    GougeParams p;
    p.radius = ball_ + params_.allowance.walls - kRapidSlack;
    if (std::isfinite(motion_.rapid_tolerance)) p.radius += motion_.rapid_tolerance;
    p.certainty = params_.certainty;
    p.limit = 0.0;
    const double clear_z = params_.stock_top_z + ball_ - kRapidSlack;
    // The ball is lowered by the rest that floors have more, as StockDepth::Rise says.
    const double rise = params_.allowance.Rise();
    const Vec3 lower = offset_ - Vec3(0, 0, rise);
    const SegmentTree tree(CollectMoves(motion_, MotionSet::kRapid, lower, clear_z - rise), Metric::kSwept,
                           radius_, run_);
    PM_ASSIGN_OR_RETURN(Extremes found, FindGouge({surface_, roots_}, tree, p, run_, "verify: rapids"));
    ReportPlaces("RAPID_IN_STOCK", found.violations, "a rapid enters the stock");
    JudgeStockSolid(clear_z);
    PM_RETURN_IF_ERROR(run_.Check());
    const SegmentTree boxes(OtherDogLegs(found, lower, clear_z - rise), Metric::kSweptBox, radius_, run_);
    PM_ASSIGN_OR_RETURN(const Extremes beside,
                        FindGouge({surface_, roots_}, boxes, p, run_, "verify: rapids"));
    ReportPlaces("RAPID_DOG_LEG", beside.violations,
                 "a control that does not drive all axes together may take a rapid into the stock");
    if (!found.violations.empty() || !beside.violations.empty()) report_.motion_ok = false;
    return absl::OkStatus();
  }

  // Steep descents faster than plunge feed must be clear of the stock.
  absl::Status JudgeDescents(const MotionFigures& figures) {
    if (figures.steep_moves.empty() || params_.keep_feed) return absl::OkStatus();
    std::vector<PathSegment> moves = CollectMoves(motion_, MotionSet::kCut, offset_);
    std::erase_if(moves, [&](const PathSegment& s) {
      return !std::binary_search(figures.steep_moves.begin(), figures.steep_moves.end(), s.move);
    });
    GougeParams p;
    p.radius = ball_ + params_.allowance.walls - kRapidSlack;
    p.chord_error = chord_error_;
    p.certainty = params_.certainty;
    p.limit = 0.0;
    std::vector<PathSegment> lower = moves;
    for (PathSegment& move : lower) {
      move.a.z() -= params_.allowance.Rise();
      move.b.z() -= params_.allowance.Rise();
    }
    const SegmentTree tree(std::move(lower), Metric::kSwept, radius_, run_);
    PM_ASSIGN_OR_RETURN(const Extremes found,
                        FindGouge({surface_, roots_}, tree, p, run_, "verify: descents"));
    int in_stock = found.violations.empty() ? -1 : found.worst.move;
    if (in_stock < 0 && params_.stock != nullptr)
      in_stock = FirstInStock(*params_.stock, moves, ball_ - kRapidSlack, false, run_);
    if (in_stock < 0) return absl::OkStatus();
    const ProgramMove& move = motion_.moves[static_cast<std::size_t>(in_stock)];
    report_.motion_ok = false;
    Report("STEEP_DESCENT", fmt::format("line {}: a descent steeper than 30 degrees into the stock at {:.6g} "
                                        "mm/min; the plunge feed is {:.6g}",
                                        move.line, move.feed, tool_.plunge_feed));
    report_.findings.back().where.line = move.line;
    return absl::OkStatus();
  }

  // Moves against the stock beside and over the part.
  void JudgeStockSolid(double clear_z) {
    if (params_.stock == nullptr) return;
    const StockSolid& stock = *params_.stock;
    const auto broken = [&](const char* code, int move, const std::string& what) {
      if (move < 0) return;
      report_.motion_ok = false;
      Report(code, fmt::format("line {}: {}", Line(move), what));
      report_.findings.back().where.line = Line(move);
    };
    const double ball = ball_ - kRapidSlack;
    broken("RAPID_IN_STOCK",
           FirstInStock(stock, CollectMoves(motion_, MotionSet::kRapid, offset_, clear_z), ball, false, run_),
           "a rapid enters the stock beside or over the part");
    broken(
        "RAPID_DOG_LEG",
        FirstInStock(stock, CollectMoves(motion_, MotionSet::kDogLegs, offset_, clear_z), ball, true, run_),
        "a control that does not drive all axes together may take a rapid into the stock beside or over "
        "the part");
    const DeepCuts deep = FindDeepCuts(stock, CollectMoves(motion_, MotionSet::kCut, offset_), ball_,
                                       params_.depth_limit, run_);
    const Vec3 tip = deep.center - offset_;
    broken("CUT_TOO_DEEP", deep.move,
           fmt::format("the ball cuts {:.3g} mm deep into the stock at X{:.4f} Y{:.4f} Z{:.4f}; the limit is "
                       "{:.3g} mm{}",
                       deep.deepest, tip.x(), tip.y(), tip.z(), deep.limit,
                       params_.depth_limit.IsOne() ? "" : " there"));
    for (const UpperCylinder& cylinder : UpperCylindersOf(tool_)) {
      const Vec3 up(0, 0, cylinder.rise);
      broken(cylinder.part == UpperPart::kShank ? "SHANK_IN_STOCK" : "HOLDER_IN_STOCK",
             FirstShankInStock(stock, CollectMoves(motion_, MotionSet::kSwept, offset_ + up), cylinder.radius,
                               cylinder.part == UpperPart::kShank ? params_.depth_limit.walls : 0.0, run_),
             fmt::format("the {} stands in the stock beside or over the part", Name(cylinder.part)));
    }
  }

  const Surface& surface_;
  const Tool& tool_;
  const ProgramMotion& motion_;
  const VerifyParams& params_;
  const RunContext& run_;
  double ball_ = 0.0, radius_ = 0.0;
  bool holder_may_hit_ = false;      // an avoided patch, or on a rapid
  bool upper_part_may_hit_ = false;  // on a rapid; it depends on the way that the control takes
  Vec3 offset_ = Vec3::Zero();       // mm, from a tip in the program frame to the ball's centre
  double chord_error_ = 0.0;
  std::vector<CellRect> roots_;
  std::vector<CellRect> wanted_;  // roots of the patches to be finished
  std::optional<VerifyLimits> limits_;
  VerifyReport report_;
};

}  // namespace

absl::StatusOr<VerifyReport> Verify(const Surface& surface, const Tool& tool, const ProgramMotion& motion,
                                    const VerifyParams& params, const RunContext& run) {
  PM_RETURN_IF_ERROR(ValidateVerifyInput(surface, tool, motion, params));
  const PolledRun polled(run);
  absl::StatusOr<VerifyReport> report = Verifier(surface, tool, motion, params, run).Run();
  PM_RETURN_IF_ERROR(run.Check());
  return report;
}

}  // namespace patchmill
