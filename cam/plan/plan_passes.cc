#include "cam/plan/plan_passes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "cam/path/contour_paths.h"
#include "cam/path/coverage.h"
#include "cam/path/keep_in_clip.h"
#include "cam/path/spacing.h"
#include "cam/path/zigzag_paths.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// Share of the tolerance that coverage may use up before a rest pass is added; the remainder is the
// verifier's certainty.
constexpr double kCoverageShare = 0.75;

void LabelRegions(const RegionMap& regions, std::vector<CutterPath>& paths) {
  for (CutterPath& path : paths) {
    std::map<int, double> length;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      const CutterPoint& p = path.points[i];
      if (!p.contact) continue;
      const double step = i > 0 ? (p.center - path.points[i - 1].center).norm() : 1e-9;
      length[regions.At(*p.contact)] += step;
    }
    double most = 0.0;
    for (const auto& [region, l] : length) {
      if (region >= 0 && l > most) {
        most = l;
        path.region = region;
      }
    }
  }
}

void Append(std::vector<CutterPath>& to, std::vector<CutterPath> from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

PassParams MakePassParams(const Job& job, const Resolved& resolved) {
  PassParams p;
  p.scallop = job.operation.scallop;
  p.chord_tolerance = resolved.budget.chord;
  p.certificate_gap = std::max(0.1 * resolved.budget.certificate, 1e-6);
  // Generators hold the centre at floor + their own radius, which includes the stock to leave.
  p.floor_z = resolved.floor_z - job.operation.leave;
  return p;
}

absl::StatusOr<PlannedPasses> PlanPasses(const Locator& locator, const RegionMap& regions, const Job& job,
                                         const Resolved& resolved, const KeepIn* keep_in,
                                         const RunContext& run) {
  const Operation& op = job.operation;
  const PassParams base = MakePassParams(job, resolved);
  PlannedPasses planned;
  if (op.strategy != Strategy::kZigzag) {
    ContourParams params;
    static_cast<PassParams&>(params) = base;
    params.window.min = op.strategy == Strategy::kAuto ? op.steep_angle : 0.0;
    PM_ASSIGN_OR_RETURN(ContourResult contours, ContourPaths(locator, params, run));
    planned.findings = std::move(contours.findings);
    Append(planned.paths, std::move(contours.paths));
  }
  if (op.strategy != Strategy::kContour) {
    ZigzagParams params;
    static_cast<PassParams&>(params) = base;
    params.window.max = op.strategy == Strategy::kAuto ? op.steep_angle : kPi / 2.0;
    params.angle = op.zigzag_angle;
    PM_ASSIGN_OR_RETURN(std::vector<CutterPath> lines, ZigzagPaths(locator, params, run));
    Append(planned.paths, std::move(lines));
  }
  if (keep_in != nullptr) {
    const double reach = CenterStep(locator.radius(), op.scallop, 0.0);
    PM_ASSIGN_OR_RETURN(planned.paths, ClipToKeepIn(locator, *keep_in, std::move(planned.paths), reach, run));
  }
  CoverageParams params;
  static_cast<PassParams&>(params) = base;
  params.limit = op.scallop + kCoverageShare * op.tolerance;
  params.tolerance = op.tolerance;
  // Forced passes answer for the ground where their steps are not clamped; the rest is reported as STRATEGY.
  if (op.strategy == Strategy::kContour) params.forced.passes = ForcedPasses::kContours;
  if (op.strategy == Strategy::kZigzag) params.forced.passes = ForcedPasses::kLines;
  params.forced.angle = op.zigzag_angle;
  params.keep_in = keep_in;
  PM_ASSIGN_OR_RETURN(std::vector<CutterPath> rest, RestPaths(locator, planned.paths, params, run));
  Append(planned.paths, std::move(rest));
  LabelRegions(regions, planned.paths);
  return planned;
}

}  // namespace patchmill
