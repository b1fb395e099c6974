#include "cam/plan/plan_passes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "cam/link/order_passes.h"
#include "cam/path/chord/chord_thinning.h"
#include "cam/path/contour/contour_paths.h"
#include "cam/path/contour/spiral_paths.h"
#include "cam/path/edge/border_passes.h"
#include "cam/path/edge/extend_passes.h"
#include "cam/path/edge/limits_clip.h"
#include "cam/path/edge/rim_passes.h"
#include "cam/path/parallel/zigzag_paths.h"
#include "cam/path/rest/leftover_spots.h"
#include "cam/path/rest/redundant_passes.h"
#include "cam/path/rest/rest_passes.h"
#include "cam/path/stepover/step_over.h"
#include "cam/region/map/pass_regions.h"
#include "core/base/status.h"
#include "core/spatial/point_cells.h"

namespace patchmill {
namespace {

// Share of the tolerance that coverage may use up before a rest pass is added; the remainder is the
// verifier's certainty.
constexpr double kCoverageShare = 0.75;
// Cosine of the angle to the lines from which on a pass runs across them.
constexpr double kAcross = 0.3;
// Share of a rest pass that has material on one side more than on the other for it to have a direction, and
// ball radii from which on one that is not closed does.
constexpr double kAlongWall = 0.5, kLong = 4.0;

void LabelRegions(const RegionMap& regions, std::vector<CutterPath>& paths) {
  for (CutterPath& path : paths) {
    double most = 0.0;
    for (const auto& [region, length] : LengthInRegions(path, regions)) {
      if (region != kNoRegion && length > most) {
        most = length;
        path.region = region;
      }
    }
  }
}

void Append(std::vector<CutterPath>& to, std::vector<CutterPath> from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

// The lines and levels of every part have numbers of their own, in the order of the parts.
void NumberAfter(const std::vector<CutterPath>& before, std::vector<CutterPath>& paths) {
  constexpr int kGap = kLineReach + 1;
  if (before.empty()) return;
  int last = 0;
  for (const CutterPath& path : before) last = std::max(last, path.order_key);
  for (CutterPath& path : paths) path.order_key += last + kGap;
}

// Drops contours shorter than `step` (mm), where a level barely touches a crest or a crease: rest passes
// finish such places. A short contour stays where another level has one next to it, as in a hole that the
// ball just fits.
void DropShortContours(double step, std::vector<CutterPath>& contours) {
  const auto is_short = [&](const CutterPath& path) {
    return path.traversal != Traversal::kSpiral && Length(path) < step;
  };
  std::vector<Vec3> places;
  std::vector<int> lines;
  for (const CutterPath& path : contours) {
    if (!is_short(path)) continue;
    places.push_back(Lift(Xy(path.points.front().center), 0.0));
    lines.push_back(path.order_key);
  }
  const PointCells cells(places, step);
  std::erase_if(contours, [&](const CutterPath& path) {
    if (!is_short(path)) return false;
    bool alone = true;
    cells.Near(Lift(Xy(path.points.front().center), 0.0), step,
               [&](std::size_t k) { alone = alone && lines[k] == path.order_key; });
    return alone;
  });
}

class PassMaker {
 public:
  PassMaker(const JobContext& context, const Locator& locator)
      : locator_(locator),
        op_(context.job.operation),
        split_angle_(context.resolved.split_angle),
        base_(MakePassParams(context.job, context.resolved)),
        run_(context.run) {}

  // Contours and lines of a part. `limits`: of the part; null: there are none. `rims`: where the surface
  // ends. `before`: the passes of the parts before it, which count against the limits of what is made here.
  absl::StatusOr<PlannedPasses> StrategyPasses(const PlanPart& part, const OperationLimits* limits,
                                               const std::vector<BorderCurve>& rims,
                                               const std::vector<CutterPath>& before) {
    const RegionChoice& choice = part.choice;
    const PathAmount made = AmountOf(before);
    PlannedPasses planned;
    std::vector<CutterPath>& paths = planned.paths;
    const auto clip = [&](std::vector<CutterPath> of) -> absl::StatusOr<std::vector<CutterPath>> {
      if (limits == nullptr) return of;
      const double reach = CenterStep(locator_.radius(), choice.scallop, 0.0);
      return ClipToLimits(locator_, *limits, std::move(of), reach, run_);
    };
    if (choice.strategy != Strategy::kZigzag) {
      PM_ASSIGN_OR_RETURN(ContourResult contours, Contours(choice, limits != nullptr, made));
      paths = std::move(contours.paths);
      planned.findings = std::move(contours.findings);
      if (op_.spirals && limits != nullptr) {
        PM_ASSIGN_OR_RETURN(paths, ClipUnthinned(choice, std::move(paths), clip));
      } else {
        PM_ASSIGN_OR_RETURN(paths, clip(std::move(paths)));
      }
    }
    if (choice.strategy != Strategy::kContour) {
      ZigzagParams params;
      params.pass = FinePassOf(choice, made);
      params.pass.budget.made += AmountOf(paths);
      params.pass.window.max = choice.strategy == Strategy::kAuto ? split_angle_ : kPi / 2.0;
      params.angle = choice.zigzag_angle;
      params.max_bend = op_.zigzag_bend;
      if (limits != nullptr && limits->HasPart()) params.part = limits;
      params.where = part.straight.get();
      PM_ASSIGN_OR_RETURN(std::vector<CutterPath> lines, ZigzagPaths(locator_, params, run_));
      if (choice.one_way) {
        for (CutterPath& line : lines) line.traversal = Traversal::kOneWay;
      }
      std::optional<SegmentTree> contours;
      if (!part.round.empty()) contours.emplace(MovesOf(paths), Metric::kPath, locator_.radius(), run_);
      for (const PlanPart::Round& round : part.round) {
        params.beside = &*contours;
        params.where = round.where.get();
        params.around = round.around;
        PM_ASSIGN_OR_RETURN(std::vector<CutterPath> circles, ZigzagPaths(locator_, params, run_));
        params.pass.budget.made += AmountOf(circles);
        NumberAfter(lines, circles);
        Append(lines, std::move(circles));
      }
      PM_ASSIGN_OR_RETURN(std::vector<CutterPath> above, RimPasses(locator_, rims, params.pass, run_, lines));
      TurnOneWay(choice, above);
      Append(lines, std::move(above));
      PM_ASSIGN_OR_RETURN(lines, clip(std::move(lines)));
      Append(paths, std::move(lines));
    }
    if (op_.spirals) {
      const PassParams params = FinePassOf(choice, made);
      const bool backwards = op_.contour_direction == CutDirection::kConventional;
      PM_ASSIGN_OR_RETURN(paths, SpiralPaths(locator_, std::move(paths), params, backwards, run_));
      PM_RETURN_IF_ERROR(ThinContours(locator_, params, MaySpiral, run_, paths));
    }
    NumberAfter(before, paths);
    PathAmount all = made;
    all += AmountOf(paths);
    PM_RETURN_IF_ERROR(CheckAmount(base_.budget.limits, all, "with lines and contours"));
    return planned;
  }

  // Passes along the borders at which the lines of this choice end: the edge of the surface, the floor, and
  // areas that are cut in another way or not at all. Limits of the operation and of the ball's own shape are
  // no such borders: the ball cannot stand on them.
  absl::StatusOr<std::vector<CutterPath>> BordersOf(const RegionMap& regions, const JobParts& job,
                                                    const RegionChoice& choice, const OperationLimits* limits,
                                                    const std::vector<CutterPath>& before) const {
    const std::vector<RegionChoice>& choices = job.choices;
    const auto region = [&](RegionId id) -> const Region& { return regions.regions[id.index()]; };
    const auto has_lines = [&](RegionId id) {
      if (id == kNoRegion || region(id).kind == RegionKind::kUnreachable) return false;
      const RegionChoice& own = choices[id.index()];
      return !own.skip && (own.strategy == Strategy::kZigzag ||
                           (own.strategy == Strategy::kAuto && region(id).slope == SlopeClass::kGentle));
    };
    const auto ends = [&](RegionId id, RegionId other) {
      if (!has_lines(id) || !CutTogether(choices[id.index()], choice) || has_lines(other)) return false;
      return other == kNoRegion || region(other).kind != RegionKind::kUnreachable ||
             region(other).reason == UnreachableReason::kFloor;
    };
    std::vector<BorderCurve> borders;
    for (const BorderLine& line : regions.border_lines) {
      if (ends(line.region, line.other) || (line.other != kNoRegion && ends(line.other, line.region)))
        borders.push_back({line.points, line.closed});
    }
    if (borders.empty()) return std::vector<CutterPath>();
    PM_ASSIGN_OR_RETURN(std::vector<CutterPath> passes,
                        BorderPasses(locator_, borders, before, FinePassOf(choice, {}), run_));
    if (limits != nullptr) {
      const double reach = CenterStep(locator_.radius(), choice.scallop, 0.0);
      PM_ASSIGN_OR_RETURN(passes, ClipToLimits(locator_, *limits, std::move(passes), reach, run_));
      std::erase_if(passes, [&](const CutterPath& pass) { return Length(pass) < 4.0 * reach; });
    }
    TurnOneWay(choice, passes);
    return passes;
  }

  RestPassParams CoverageOf(const RegionChoice& choice, const OperationLimits* limits) const {
    RestPassParams params;
    params.pass = PassOf(choice, {});
    params.limit = choice.scallop + kCoverageShare * op_.tolerance;
    params.tolerance = op_.tolerance;
    // Forced passes answer for places where their steps are not clamped; the rest is reported as STRATEGY.
    params.forced = ForcedOf(choice);
    params.operation_limits = limits;
    return params;
  }

  // Where the passes `before` leave more than `params` allows.
  absl::StatusOr<std::vector<CutterPath>> RestOf(const RegionChoice& choice, const Locator& reach,
                                                 const RestPassParams& params,
                                                 const std::vector<CutterPath>& before) const {
    RestPassParams counted = params;
    counted.pass.budget.made = AmountOf(before);
    PM_ASSIGN_OR_RETURN(std::vector<CutterPath> rest, RestPaths(locator_, reach, before, counted, run_));
    TurnAlongWalls(choice, rest);
    TurnOneWay(choice, rest);
    return rest;
  }

 private:
  // Rest passes between lines that run one way run that way, too, unless they run across it.
  static void TurnOneWay(const RegionChoice& choice, std::vector<CutterPath>& paths) {
    if (!choice.one_way || choice.strategy == Strategy::kContour) return;
    const Vec2 way(std::cos(choice.zigzag_angle), std::sin(choice.zigzag_angle));
    for (CutterPath& path : paths) {
      if (path.closed || path.points.size() < 2) continue;
      const Vec3 d = path.points.back().center - path.points.front().center;
      const double along = way.dot(Xy(d));
      if (std::abs(along) < kAcross * d.norm()) continue;
      if (along < 0.0) Reverse(path);
      path.traversal = Traversal::kOneWay;
    }
  }

  // Long passes along walls run as contours do: for climb milling the material is on their right.
  void TurnAlongWalls(const RegionChoice& choice, std::vector<CutterPath>& paths) const {
    if (choice.strategy == Strategy::kZigzag || op_.contour_direction == CutDirection::kEither) return;
    const double side = op_.contour_direction == CutDirection::kClimb ? 1.0 : -1.0;
    const double least = choice.strategy == Strategy::kContour ? 0.0 : std::sin(split_angle_);
    for (CutterPath& path : paths) {
      const double length = Length(path);
      if (!path.closed && length < kLong * locator_.radius()) continue;
      double on_right = 0.0;  // mm
      for (std::size_t i = 0; i + (path.closed ? 0 : 1) < path.points.size(); ++i) {
        const CutterPoint &from = path.points[i], &to = path.points[(i + 1) % path.points.size()];
        if (!from.contact || from.other_contact) continue;
        const Vec2 inwards = Xy(from.contact->p - from.center) / locator_.radius();
        if (inwards.norm() >= least && inwards.norm() > 0.0)
          on_right += Cross(inwards.normalized(), Xy(to.center - from.center));
      }
      if (std::abs(on_right) < kAlongWall * length) continue;
      if (side * on_right < 0.0) Reverse(path);
      path.traversal = Traversal::kDirected;
    }
  }

  // Contours that no limit has cut.
  static bool MaySpiral(const CutterPath& path) {
    return path.closed || path.traversal == Traversal::kSpiral;
  }

  // Spirals are wound from contours as they were traced. All other contours lose their superfluous points
  // before limits cut them, because an end on a chord is not one of the points that were traced.
  template <class Clip>
  absl::StatusOr<std::vector<CutterPath>> ClipUnthinned(const RegionChoice& choice,
                                                        std::vector<CutterPath> paths,
                                                        const Clip& clip) const {
    std::vector<int> lines;
    for (CutterPath& path : paths) {
      lines.push_back(path.order_key);
      path.order_key = static_cast<int>(lines.size()) - 1;
    }
    PM_ASSIGN_OR_RETURN(std::vector<CutterPath> clipped, clip(paths));
    std::erase_if(clipped, [](const CutterPath& path) { return !MaySpiral(path); });
    std::vector<char> whole(paths.size(), 0);
    for (const CutterPath& path : clipped) whole[static_cast<std::size_t>(path.order_key)] = 1;
    std::erase_if(
        paths, [&](const CutterPath& path) { return whole[static_cast<std::size_t>(path.order_key)] != 0; });
    PM_RETURN_IF_ERROR(ThinContours(locator_, FinePassOf(choice, {}), MaySpiral, run_, paths));
    PM_ASSIGN_OR_RETURN(paths, clip(std::move(paths)));
    Append(clipped, std::move(paths));
    std::stable_sort(clipped.begin(), clipped.end(),
                     [](const CutterPath& a, const CutterPath& b) { return a.order_key < b.order_key; });
    for (CutterPath& path : clipped) path.order_key = lines[static_cast<std::size_t>(path.order_key)];
    return clipped;
  }

  // Contours over the whole steep area. Parts that differ in their lines alone share them; the first part has
  // the findings. With `cut_off` limits clip them afterwards: their length does not count yet, but their
  // points do, because they are in memory.
  absl::StatusOr<ContourResult> Contours(const RegionChoice& choice, bool cut_off, const PathAmount& made) {
    const bool all = choice.strategy == Strategy::kContour;
    if (const auto known = contours_.find({all, choice.scallop}); known != contours_.end()) {
      return ContourResult{known->second, {}};
    }
    ContourParams params;
    params.pass = FinePassOf(choice, made);
    params.pass.window.min = all ? 0.0 : split_angle_;
    if (cut_off) params.pass.budget.limits.length = kInfinity;
    PM_ASSIGN_OR_RETURN(ContourResult contours, ContourPaths(locator_, params, run_));
    DropShortContours(CenterStep(locator_.radius(), choice.scallop, 0.0), contours.paths);
    // Spirals are made of contours as they are.
    const auto now = [&](const CutterPath& path) { return !(op_.spirals && MaySpiral(path)); };
    PM_RETURN_IF_ERROR(ThinContours(locator_, params.pass, now, run_, contours.paths));
    contours_[{all, choice.scallop}] = contours.paths;
    return contours;
  }

  PassParams PassOf(const RegionChoice& choice, const PathAmount& made) const {
    PassParams params = base_;
    params.scallop = choice.scallop;
    params.budget.made = made;
    return params;
  }

  // Of passes that lie side by side.
  PassParams FinePassOf(const RegionChoice& choice, const PathAmount& made) const {
    return WithFineChords(PassOf(choice, made));
  }

  const Locator& locator_;
  const Operation& op_;
  const double split_angle_;
  PassParams base_;
  const RunContext& run_;
  std::map<std::pair<bool, double>, std::vector<CutterPath>> contours_;
};

}  // namespace

PassParams MakePassParams(const Job& job, const Resolved& resolved) {
  PassParams p;
  p.scallop = job.operation.scallop;
  p.chord_tolerance = resolved.budget.chord;
  p.certificate_gap = std::max(0.1 * resolved.budget.certificate, 1e-6);
  // Generators hold the centre at floor + their own radius, which includes the stock to leave.
  p.floor_z = resolved.plan_floor_z - job.operation.leave;
  p.roll = job.operation.edge_rule == EdgeRule::kRoll;
  p.budget.limits = job.path_limits;
  return p;
}

JobParts PartsOfJob(const JobContext& context, const RegionMap& map, std::vector<RegionChoice> choices) {
  JobParts job;
  job.parts = PartsOf(map, choices);
  job.choices = std::move(choices);
  const bool whole = job.parts.size() == 1 && job.parts.front().where == nullptr;
  if (!whole || !context.limits.WantsAll() || !context.limits.AllowsAll()) job.limits = &context.limits;
  return job;
}

absl::StatusOr<PlannedPasses> PlanPasses(const JobContext& context, const Locator& locator,
                                         const RegionMap& regions, const JobParts& job) {
  const Operation& op = context.job.operation;
  const std::vector<PlanPart>& parts = job.parts;
  std::vector<std::optional<OperationLimits>> own(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k].where == nullptr) continue;
    PM_CHECK(job.limits != nullptr);
    PM_ASSIGN_OR_RETURN(OperationLimits within, job.limits->Within(parts[k].where, context.run));
    own[k].emplace(std::move(within));
  }
  const auto limits = [&](std::size_t k) { return own[k] ? &*own[k] : job.limits; };

  PlannedPasses planned;
  PassMaker maker(context, locator);
  std::vector<BorderCurve> rims;  // where the surface ends
  if (op.border_passes) {
    for (const BorderLine& line : regions.border_lines)
      if (line.other == kNoRegion) rims.push_back({line.points, line.closed});
  }
  for (std::size_t k = 0; k < parts.size(); ++k) {
    PM_ASSIGN_OR_RETURN(PlannedPasses more, maker.StrategyPasses(parts[k], limits(k), rims, planned.paths));
    Append(planned.paths, std::move(more.paths));
    planned.findings.insert(planned.findings.end(), more.findings.begin(), more.findings.end());
  }
  if (op.border_passes) {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      PM_ASSIGN_OR_RETURN(std::vector<CutterPath> more,
                          maker.BordersOf(regions, job, parts[k].choice, limits(k), planned.paths));
      Append(planned.paths, std::move(more));
    }
  }
  // After all parts: along a border the passes of one part finish places of the next.
  RestPassParams any;
  any.tolerance = op.tolerance;
  PM_ASSIGN_OR_RETURN(const Locator reach, ReachLocator(locator, any, context.run));
  std::vector<RestPassParams> coverage;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    coverage.push_back(maker.CoverageOf(parts[k].choice, limits(k)));
    PM_ASSIGN_OR_RETURN(std::vector<CutterPath> rest,
                        maker.RestOf(parts[k].choice, reach, coverage.back(), planned.paths));
    Append(planned.paths, std::move(rest));
  }
  PM_ASSIGN_OR_RETURN(planned.paths,
                      RemoveRedundantPasses(locator, reach, std::move(planned.paths), coverage, context.run));
  LabelRegions(regions, planned.paths);
  if (op.edge_rule == EdgeRule::kExtend) {
    PM_ASSIGN_OR_RETURN(planned.paths, ExtendPasses(locator, std::move(planned.paths),
                                                    {MakePassParams(context.job, context.resolved),
                                                     locator.radius(), job.limits},
                                                    context.run));
  }
  return planned;
}

}  // namespace patchmill
