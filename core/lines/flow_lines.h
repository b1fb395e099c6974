// Flow lines: the lines orthogonal to contours [lines (3)] and to lines of equal slope [lines (7)], which
// follow the gradient of a function on the surface, and the lines of curvature, which follow the principal
// directions [shapes, section 9]. They are evenly spread [references: jobard1997].
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/lines/zero_curves.h"
#include "core/surface/surface.h"

namespace patchmill {

enum class FlowKind {
  kAlongHeight,     // up the gradient of phi = axis . S, where water runs
  kAlongSlope,      // up the gradient of |axis . n|, towards gentler slopes
  kAlongCurvature,  // along either principal direction, in both families; the axis has no effect
};

struct FlowParams {
  FlowKind kind = FlowKind::kAlongHeight;
  Vec3 axis = Vec3::UnitZ();  // unit
  double spacing = 1.0;       // mm, > 0; new lines begin this far from all others and end at half of it
  double tolerance = 0.01;    // mm, > 0; for chords and for one step
  std::size_t max_points = 1'000'000;
};

// Half the difference of the principal curvatures counts as none up to this share of their mean, and up to
// kLeastBend / spacing. Such a place is an umbilic: every direction is a principal one.
inline constexpr double kUmbilic = 1e-4, kLeastBend = 1e-6;

struct FlowLines {
  std::vector<ZeroCurve> curves;
  bool all_singular = true;  // the flow has a direction at none of the places where a line could begin
};

// Traces lines in the direction in which the function grows. They end at four kinds of places: singular
// points (|gradient| below 1e-6, per mm of spacing for kAlongSlope; or the gradient turns back); the border
// of the surface; places without a normal; places near other lines. Lines shorter than half the spacing are
// left out. A line of curvature follows at each place the principal direction nearest to the way it came, so
// it does not matter on which side of a face the normal lies. It ends at umbilics, and where the direction
// jumps by more than 30 degrees from one piece to the next. It is closed if it comes back to its start within
// twice the tolerance. If it comes back beside the start, it ends half a spacing from itself. Only lines of
// the same family count as near: those that run within 45 degrees of it. Each step is at most a tenth of the
// tolerance from the true line through its start, as two half steps show; these errors add up along a line.
// Chords deviate from it by at most `tolerance`.
// The order is that in which the lines were begun. Deterministic, one thread. RESOURCE_EXHAUSTED for more
// than max_points, some 200 bytes each; CANCELLED and DEADLINE_EXCEEDED from `run`. Cost: some
// microseconds per step, and a closest-point query at each patch border and for each new line.
absl::StatusOr<FlowLines> TraceFlowLines(const Surface& surface, const FlowParams& params,
                                         const RunContext& run);

// The gradient on the surface of the flow's function (none for kAlongCurvature), as a tangent vector in
// space. Zero where there is no normal. With the derivatives (f_u, f_v) of the function it is
// ((f_u G - f_v F) S_u + (f_v E - f_u F) S_v) / W.
Vec3 FlowGradient(const SurfaceJet& jet, const FlowParams& params);

}  // namespace patchmill
