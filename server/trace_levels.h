// Traces the levels of families of lines: what TraceLines and Preview have in common.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/lines/zero_curves.h"
#include "core/surface/surface.h"
#include "server/convert/lines.h"

namespace patchmill {

// One level of one family, with its curves.
struct TracedLevel {
  int family = 0;      // position of its order
  double level = 0.0;  // in the unit of the domain; 0 for a family without levels
  std::vector<ZeroCurve> curves;
  bool all_umbilic = false;  // lines of curvature have no direction anywhere
};

struct TraceParams {
  ZeroMeshParams mesh;
  double tolerance = 0.01;   // mm, chord of the curves
  Vec3 zero = Vec3::Zero();  // program zero: heights that are chosen are round numbers from there
};

// The levels of all orders in their order, placed (Placed). Levels that are not given are chosen over the
// range of the surface. Errors: RESOURCE_EXHAUSTED for more points than an answer may have, or flow lines
// that are too close; those of `run`.
absl::StatusOr<std::vector<TracedLevel>> TraceLevels(const Surface& surface,
                                                     const std::vector<LineOrder>& orders,
                                                     const TraceParams& params, const RunContext& run);

// The message of a level, without its lines.
v1::LineSet SetOf(const TracedLevel& level, const LineOrder& order, const Vec3& zero);

}  // namespace patchmill
