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
      if (region >= 0 && length > most) {
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

// Contours shorter than `step` (mm) where a level barely touches a crest or a crease: ground that needs them
// gets rest passes. Not where other levels have such ones beside them, as in a hole that the ball just fits.
void DropCrumbs(double step, std::vector<CutterPath>& contours) {
  const auto is_crumb = [&](const CutterPath& path) { return !path.spiral && Length(path) < step; };
  std::vector<Vec3> places;
  std::vector<int> lines;
  for (const CutterPath& path : contours) {
    if (!is_crumb(path)) continue;
    places.push_back(Lift(Xy(path.points.front().center), 0.0));
    lines.push_back(path.order_key);
  }
  const PointCells cells(places, step);
  std::erase_if(contours, [&](const CutterPath& path) {
    if (!is_crumb(path)) return false;
    bool alone = true;
    cells.Near(Lift(Xy(path.points.front().center), 0.0), step,
               [&](std::size_t k) { alone = alone && lines[k] == path.order_key; });
    return alone;
  });
}

class PassMaker {
 public:
  PassMaker(const Locator& locator, const Job& job, const Resolved& resolved, const RunContext& run)
      : locator_(locator),
        op_(job.operation),
        split_angle_(resolved.split_angle),
        base_(MakePassParams(job, resolved)),
        run_(run) {}

  // What has been added so far counts against the limits of what is made next.
  absl::Status AddStrategies(const PlanPart& part, const std::vector<BorderCurve>& rims,
                             const OperationLimits* operation_limits, PlannedPasses& planned) {
    const RegionChoice& choice = part.choice;
    std::vector<CutterPath> paths;
    const auto clip = [&](std::vector<CutterPath> of) -> absl::StatusOr<std::vector<CutterPath>> {
      if (operation_limits == nullptr) return of;
      const double reach = CenterStep(locator_.radius(), choice.scallop, 0.0);
      return ClipToLimits(locator_, *operation_limits, std::move(of), reach, run_);
    };
    base_.budget.made = AmountOf(planned.paths);
    if (choice.strategy != Strategy::kZigzag) {
      PM_ASSIGN_OR_RETURN(paths, Contours(choice, operation_limits != nullptr, planned.findings));
      if (op_.spirals && operation_limits != nullptr) {
        PM_ASSIGN_OR_RETURN(paths, ClipUnthinned(choice, std::move(paths), clip));
      } else {
        PM_ASSIGN_OR_RETURN(paths, clip(std::move(paths)));
      }
    }
    if (choice.strategy != Strategy::kContour) {
      ZigzagParams params;
      SetFinePass(choice, params);
      params.budget.made += AmountOf(paths);
      params.window.max = choice.strategy == Strategy::kAuto ? split_angle_ : kPi / 2.0;
      params.angle = choice.zigzag_angle;
      params.max_bend = op_.zigzag_bend;
      if (operation_limits != nullptr && operation_limits->HasPart()) params.part = operation_limits;
      params.where = part.straight.get();
      PM_ASSIGN_OR_RETURN(std::vector<CutterPath> lines, ZigzagPaths(locator_, params, run_));
      for (CutterPath& line : lines) line.one_way = choice.one_way;
      std::optional<SegmentTree> contours;
      if (!part.round.empty()) contours.emplace(MovesOf(paths), Metric::kPath, locator_.radius(), run_);
      for (const PlanPart::Round& round : part.round) {
        params.beside = &*contours;
        params.where = round.where.get();
        params.around = round.around;
        PM_ASSIGN_OR_RETURN(std::vector<CutterPath> circles, ZigzagPaths(locator_, params, run_));
        params.budget.made += AmountOf(circles);
        NumberAfter(lines, circles);
        Append(lines, std::move(circles));
      }
      PM_ASSIGN_OR_RETURN(std::vector<CutterPath> above, RimPasses(locator_, rims, params, run_, lines));
      TurnOneWay(choice, above);
      Append(lines, std::move(above));
      PM_ASSIGN_OR_RETURN(lines, clip(std::move(lines)));
      Append(paths, std::move(lines));
    }
    if (op_.spirals) {
      PassParams params;
      SetFinePass(choice, params);
      const bool backwards = op_.contour_direction == CutDirection::kConventional;
      PM_ASSIGN_OR_RETURN(paths, SpiralPaths(locator_, std::move(paths), params, backwards, run_));
      PM_RETURN_IF_ERROR(ThinContours(locator_, params, MaySpiral, run_, paths));
    }
    NumberAfter(planned.paths, paths);
    Append(planned.paths, std::move(paths));
    return CheckAmount(base_.budget.limits, AmountOf(planned.paths), "with lines and contours");
  }

  // Along the borders that end the lines of this choice: the edge of the surface, the floor, and ground that
  // is cut in another way or not at all. Limits of the operation and of the ball's own shape are none: the
  // ball cannot stand on them.
  absl::Status AddBorders(const RegionMap& regions, const std::vector<RegionChoice>& choices,
                          const RegionChoice& choice, const OperationLimits* operation_limits,
                          PlannedPasses& planned) const {
    const auto region = [&](int id) -> const Region& {
      return regions.regions[static_cast<std::size_t>(id)];
    };
    const auto has_lines = [&](int id) {
      if (id < 0 || region(id).kind == RegionKind::kUnreachable) return false;
      const RegionChoice& own = choices[static_cast<std::size_t>(id)];
      return !own.skip && (own.strategy == Strategy::kZigzag ||
                           (own.strategy == Strategy::kAuto && region(id).slope == SlopeClass::kGentle));
    };
    const auto ends = [&](int id, int other) {
      if (!has_lines(id) || !CutTogether(choices[static_cast<std::size_t>(id)], choice) || has_lines(other))
        return false;
      return other < 0 || region(other).kind != RegionKind::kUnreachable ||
             region(other).reason == UnreachableReason::kFloor;
    };
    std::vector<BorderCurve> borders;
    for (const BorderLine& line : regions.border_lines) {
      if (ends(line.region, line.other) || (line.other >= 0 && ends(line.other, line.region)))
        borders.push_back({line.points, line.closed});
    }
    if (borders.empty()) return absl::OkStatus();
    PassParams params;
    SetFinePass(choice, params);
    PM_ASSIGN_OR_RETURN(std::vector<CutterPath> passes,
                        BorderPasses(locator_, borders, planned.paths, params, run_));
    if (operation_limits != nullptr) {
      const double reach = CenterStep(locator_.radius(), choice.scallop, 0.0);
      PM_ASSIGN_OR_RETURN(passes, ClipToLimits(locator_, *operation_limits, std::move(passes), reach, run_));
      std::erase_if(passes, [&](const CutterPath& pass) { return Length(pass) < 4.0 * reach; });
    }
    TurnOneWay(choice, passes);
    Append(planned.paths, std::move(passes));
    return absl::OkStatus();
  }

  RestPassParams CoverageOf(const RegionChoice& choice, const OperationLimits* operation_limits) const {
    RestPassParams params;
    SetPass(choice, params);
    params.limit = choice.scallop + kCoverageShare * op_.tolerance;
    params.tolerance = op_.tolerance;
    // Forced passes answer for the ground where their steps are not clamped; the rest is reported as
    // STRATEGY.
    params.forced = ForcedOf(choice);
    params.operation_limits = operation_limits;
    return params;
  }

  absl::Status AddRest(const RegionChoice& choice, const Locator& reach, const RestPassParams& params,
                       PlannedPasses& planned) const {
    RestPassParams counted = params;
    counted.budget.made = AmountOf(planned.paths);
    PM_ASSIGN_OR_RETURN(std::vector<CutterPath> rest,
                        RestPaths(locator_, reach, planned.paths, counted, run_));
    TurnAlongWalls(choice, rest);
    TurnOneWay(choice, rest);
    Append(planned.paths, std::move(rest));
    return absl::OkStatus();
  }

 private:
  // What mends lines that run one way runs that way too, but for what runs across it.
  static void TurnOneWay(const RegionChoice& choice, std::vector<CutterPath>& paths) {
    if (!choice.one_way || choice.strategy == Strategy::kContour) return;
    const Vec2 way(std::cos(choice.zigzag_angle), std::sin(choice.zigzag_angle));
    for (CutterPath& path : paths) {
      if (path.closed || path.points.size() < 2) continue;
      const Vec3 d = path.points.back().center - path.points.front().center;
      const double along = way.dot(Xy(d));
      if (std::abs(along) < kAcross * d.norm()) continue;
      if (along < 0.0) Reverse(path);
      path.one_way = true;
    }
  }

  // What runs along walls for more than a spot's length runs as contours do, material on the right for climb.
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
      path.directed = true;
    }
  }

  // What no limit has cut.
  static bool MaySpiral(const CutterPath& path) { return path.closed || path.spiral; }

  // Spirals are wound of contours as they were traced, all others lose the points that their chords can do
  // without before limits cut them: ends on chords are of another kind.
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
    PassParams params;
    SetFinePass(choice, params);
    PM_RETURN_IF_ERROR(ThinContours(locator_, params, MaySpiral, run_, paths));
    PM_ASSIGN_OR_RETURN(paths, clip(std::move(paths)));
    Append(clipped, std::move(paths));
    std::stable_sort(clipped.begin(), clipped.end(),
                     [](const CutterPath& a, const CutterPath& b) { return a.order_key < b.order_key; });
    for (CutterPath& path : clipped) path.order_key = lines[static_cast<std::size_t>(path.order_key)];
    return clipped;
  }

  // Over all ground that is steep enough; parts that differ in their lines alone share them. When limits cut
  // them off afterwards their length does not count yet; their points do, for they are held.
  absl::StatusOr<std::vector<CutterPath>> Contours(const RegionChoice& choice, bool cut_off,
                                                   Diagnostics& findings) {
    const bool all = choice.strategy == Strategy::kContour;
    if (const auto known = contours_.find({all, choice.scallop}); known != contours_.end()) {
      return known->second;
    }
    ContourParams params;
    SetFinePass(choice, params);
    params.window.min = all ? 0.0 : split_angle_;
    if (cut_off) params.budget.limits.length = kInfinity;
    PM_ASSIGN_OR_RETURN(ContourResult contours, ContourPaths(locator_, params, run_));
    DropCrumbs(CenterStep(locator_.radius(), choice.scallop, 0.0), contours.paths);
    // Spirals are made of contours as they are.
    const auto now = [&](const CutterPath& path) { return !(op_.spirals && MaySpiral(path)); };
    PM_RETURN_IF_ERROR(ThinContours(locator_, params, now, run_, contours.paths));
    findings.insert(findings.end(), contours.findings.begin(), contours.findings.end());
    return contours_[{all, choice.scallop}] = std::move(contours.paths);
  }

  void SetPass(const RegionChoice& choice, PassParams& params) const {
    params = base_;
    params.scallop = choice.scallop;
  }

  // Of passes that lie side by side.
  void SetFinePass(const RegionChoice& choice, PassParams& params) const {
    SetPass(choice, params);
    params = WithFineChords(params);
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
  p.floor_z = resolved.floor_z - job.operation.leave;
  p.roll = job.operation.edge_rule == EdgeRule::kRoll;
  p.budget.limits = job.path_limits;
  return p;
}

absl::StatusOr<PlannedPasses> PlanPasses(const Locator& locator, const RegionMap& regions,
                                         const std::vector<RegionChoice>& choices,
                                         const std::vector<PlanPart>& parts, const Job& job,
                                         const Resolved& resolved, const OperationLimits* operation_limits,
                                         const RunContext& run) {
  PlannedPasses planned;
  PassMaker maker(locator, job, resolved, run);
  std::vector<std::optional<OperationLimits>> own(parts.size());
  const auto limits = [&](std::size_t k) { return own[k] ? &*own[k] : operation_limits; };
  std::vector<BorderCurve> rims;  // where the surface ends
  if (job.operation.border_passes) {
    for (const BorderLine& line : regions.border_lines)
      if (line.other < 0) rims.push_back({line.points, line.closed});
  }
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k].where != nullptr) {
      PM_CHECK(operation_limits != nullptr);
      PM_ASSIGN_OR_RETURN(OperationLimits within, operation_limits->Within(parts[k].where, run));
      own[k].emplace(std::move(within));
    }
    PM_RETURN_IF_ERROR(maker.AddStrategies(parts[k], rims, limits(k), planned));
  }
  if (job.operation.border_passes) {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      PM_RETURN_IF_ERROR(maker.AddBorders(regions, choices, parts[k].choice, limits(k), planned));
    }
  }
  // After all of them: along a border the passes of one part finish some of the next.
  RestPassParams any;
  any.tolerance = job.operation.tolerance;
  PM_ASSIGN_OR_RETURN(const Locator reach, ReachLocator(locator, any, run));
  std::vector<RestPassParams> coverage;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    coverage.push_back(maker.CoverageOf(parts[k].choice, limits(k)));
    PM_RETURN_IF_ERROR(maker.AddRest(parts[k].choice, reach, coverage.back(), planned));
  }
  PM_ASSIGN_OR_RETURN(planned.paths,
                      RemoveRedundantPasses(locator, reach, std::move(planned.paths), coverage, run));
  LabelRegions(regions, planned.paths);
  if (job.operation.edge_rule == EdgeRule::kExtend) {
    PM_ASSIGN_OR_RETURN(planned.paths, ExtendPasses(locator, std::move(planned.paths), locator.radius(),
                                                    MakePassParams(job, resolved), operation_limits, run));
  }
  return planned;
}

}  // namespace patchmill
