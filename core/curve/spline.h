// Interpolating cubic splines: twice continuously differentiable in the chord parameter.
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "core/curve/curve.h"

namespace patchmill {

struct SplineEnds {
  // Derivatives per unit of chord at the ends. An end without one is natural (no curvature). Unused when
  // closed.
  std::optional<Vec3> start, end;
  // Second derivatives per square of the chord, at ends whose derivative is not given; zero at natural ends.
  Vec3 start_second = Vec3::Zero(), end_second = Vec3::Zero();
};

// One cubic per pair of neighbours (when closed, also from the last point to the first), each with its own
// parameter in [0,1]. At the point between them, neighbours share tangent line and curvature vector. Residual
// about 1e-15 of the chords. Cost O(n). INVALID_ARGUMENT for fewer than two points (closed: three), for
// neighbours that coincide, and for numbers that are not finite.
absl::StatusOr<std::vector<HermiteCurve>> SplineThrough(const std::vector<Vec3>& points, bool closed,
                                                        const SplineEnds& ends = {});

// The spline in a given parameter. spans[i] > 0 is the length of the span from point i to the next. With as
// many spans as points it is closed. The derivatives at the ends are per unit of this parameter. Needs two
// points or more (closed: three).
std::vector<HermiteCurve> SplineOver(const std::vector<Vec3>& points, const std::vector<double>& spans,
                                     const SplineEnds& ends = {});

}  // namespace patchmill
