#include "server/trace_levels.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/base/status.h"
#include "core/lines/flow_lines.h"
#include "core/lines/line_family.h"
#include "core/lines/patch_crossings.h"
#include "server/errors.h"
#include "server/limits.h"

namespace patchmill {
namespace {

// Counts the points of all lines and compares them with the limit of an answer.
class PointCount {
 public:
  absl::Status Add(const std::vector<ZeroCurve>& curves) {
    for (const ZeroCurve& curve : curves) points_ += static_cast<double>(curve.points.size());
    if (points_ <= limits::kMaxPolylinePoints) return absl::OkStatus();
    return LimitError("line_points", limits::kMaxPolylinePoints, points_);
  }

 private:
  double points_ = 0.0;
};

absl::StatusOr<FlowLines> TraceFlow(const Surface& surface, FlowParams flow, double tolerance,
                                    const RunContext& run) {
  constexpr double kUsual = 1.0 / 40.0, kClosest = 1e-3;  // shares of the diagonal of the box
  const double diagonal = surface.box.Diagonal();
  if (flow.spacing == 0.0) flow.spacing = kUsual * diagonal;
  if (flow.spacing < kClosest * diagonal)
    return LimitError("1/spacing_mm", 1.0 / (kClosest * diagonal), 1.0 / flow.spacing);
  flow.tolerance = tolerance;
  flow.max_points = static_cast<std::size_t>(limits::kMaxPolylinePoints);
  return TraceFlowLines(surface, flow, run);
}

}  // namespace

absl::StatusOr<std::vector<TracedLevel>> TraceLevels(const Surface& surface,
                                                     const std::vector<LineOrder>& orders,
                                                     const TraceParams& params, const RunContext& run) {
  std::vector<TracedLevel> levels;
  std::vector<ZeroField> fields;
  std::vector<std::size_t> of_field;  // position of its level
  PointCount points;
  for (std::size_t k = 0; k < orders.size(); ++k) {
    const int family = static_cast<int>(k);
    if (orders[k].crossings) {
      PM_ASSIGN_OR_RETURN(Crossings3d crossings,
                          FindPatchCrossings(surface, {.tolerance = params.tolerance}, run));
      PM_RETURN_IF_ERROR(points.Add(crossings.curves));
      levels.push_back({family, 0.0, std::move(crossings.curves)});
      continue;
    }
    if (orders[k].flow) {
      PM_ASSIGN_OR_RETURN(FlowLines flow, TraceFlow(surface, *orders[k].flow, params.tolerance, run));
      PM_RETURN_IF_ERROR(points.Add(flow.curves));
      const bool umbilic = orders[k].flow->kind == FlowKind::kAlongCurvature && flow.all_singular;
      levels.push_back({family, 0.0, std::move(flow.curves), umbilic});
      continue;
    }
    std::vector<double> wanted = orders[k].levels;
    if (!HasLevels(orders[k])) {
      wanted = {0.0};
    } else if (wanted.empty() && orders[k].count > 0) {
      wanted = ChooseLevels(surface, orders[k].family, orders[k].count, params.zero);
    }
    for (const double level : wanted) {
      of_field.push_back(levels.size());
      levels.push_back({family, level, {}});
      fields.push_back(FieldOf(orders[k].family, level));
    }
  }
  // A few fields at a time, so that too many points are noticed before they fill the memory.
  constexpr std::size_t kAtOnce = 8;
  for (std::size_t first = 0; first < fields.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, fields.size() - first);
    PM_ASSIGN_OR_RETURN(std::vector<std::vector<ZeroCurve>> curves,
                        TraceZeroCurves(surface, std::span(fields).subspan(first, count), params.mesh,
                                        params.tolerance, run));
    for (std::size_t k = 0; k < count; ++k) {
      PM_RETURN_IF_ERROR(points.Add(curves[k]));
      levels[of_field[first + k]].curves = std::move(curves[k]);
    }
  }
  return levels;
}

v1::LineSet SetOf(const TracedLevel& level, const LineOrder& order, const Vec3& zero) {
  v1::LineSet set;
  set.set_family_index(level.family);
  set.set_kind(order.kind);
  set.set_level(HasLevels(order) ? WireLevel(order, level.level, zero) : 0.0);
  double length = 0.0;
  for (const ZeroCurve& curve : level.curves) length += LengthOf(curve);
  set.set_length_mm(length);
  AddChosen(order, set);
  return set;
}

}  // namespace patchmill
