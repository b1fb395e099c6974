#include "core/trim/face_trace.h"

#include <cstddef>
#include <utility>

#include <absl/status/statusor.h>
#include <absl/strings/str_format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/trim/lower_degree.h"
#include "core/trim/strip_net.h"

namespace patchmill {
namespace {

constexpr double kIsoTolerance = 1e-7;  // mm

// The file's parameters that the loops reach.
struct HintBox {
  Vec2 low = Vec2::Constant(kInfinity), high = Vec2::Constant(-kInfinity);
};
HintBox BoxOfHints(const BrepFace& face) {
  HintBox box;
  for (const BrepLoop& loop : face.loops) {
    for (const BrepEdgeUse& use : loop) {
      for (const Vec2& h : use.hint) {
        box.low = box.low.cwiseMin(h);
        box.high = box.high.cwiseMax(h);
      }
    }
  }
  return box;
}

// A border that is no line of the parameters needs strips, and their degrees have a limit.
bool NeedsLowerDegrees(const GridTrace& trace) {
  const BernsteinNet& net = trace.grid.carriers.front().net;
  if (LargestStripDegree(net, true) > 0 && LargestStripDegree(net, false) > 0) return false;
  for (const std::vector<UseTrace>& loop : trace.border.loops) {
    if (std::any_of(loop.begin(), loop.end(), [](const UseTrace& use) { return use.iso < 0; })) return true;
  }
  return false;
}

absl::StatusOr<GridTrace> TraceOnGrid(const BrepFace& face, const EdgeCurveTable& curves) {
  const HintBox box = BoxOfHints(face);
  if (!(box.low.x() <= box.high.x())) return absl::FailedPreconditionError("the face has no border");
  GridTrace trace;
  trace.surface_error = face.surface_error;
  trace.grid = CarriersOf(face.surface, box.low, box.high);
  PM_ASSIGN_OR_RETURN(trace.border, TraceBorder(face, curves, trace.grid, kIsoTolerance));
  if (!NeedsLowerDegrees(trace)) return trace;
  PM_ASSIGN_OR_RETURN(LoweredGrid lowered, WithLowerDegrees(trace.grid, kSurfaceTolerance));
  trace.grid = std::move(lowered.grid);
  trace.surface_error += lowered.error;
  PM_ASSIGN_OR_RETURN(trace.border, TraceBorder(face, curves, trace.grid, kIsoTolerance));
  return trace;
}

std::vector<std::vector<double>> BreaksOf(const GridTrace& trace, const EdgeCurveTable& curves) {
  std::vector<std::vector<double>> breaks;
  for (const std::vector<UseTrace>& loop : trace.border.loops) {
    for (const UseTrace& use : loop) {
      breaks.push_back(use.iso >= 0 ? std::vector<double>()
                                    : NaturalBreaks(trace.grid, curves[At(use.edge)], use));
    }
  }
  return breaks;
}

}  // namespace

double TracedFace::gap() const {
  if (const GridTrace* trace = grid()) return trace->border.gap;
  const auto* plane = std::get_if<PlanePatches>(&result);
  return plane == nullptr ? 0.0 : plane->gap;
}

TracedFace TraceFace(const BrepFace& face, const EdgeCurveTable& curves, const RunContext& run) {
  if (const auto* plane = std::get_if<BrepPlane>(&face.surface)) {
    absl::StatusOr<PlanePatches> cut = CutPlane(plane->frame, face.loops, curves, run);
    if (!cut.ok()) return {cut.status(), {}};
    std::vector<std::vector<double>> breaks = cut->breaks;
    return {*std::move(cut), std::move(breaks)};
  }
  absl::StatusOr<GridTrace> trace = TraceOnGrid(face, curves);
  if (!trace.ok()) return {trace.status(), {}};
  std::vector<std::vector<double>> breaks = BreaksOf(*trace, curves);
  return {*std::move(trace), std::move(breaks)};
}

}  // namespace patchmill
