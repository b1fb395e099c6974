// Cubic splines in the chord parameter with given directions or curvatures at their ends.
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "core/curve/curve.h"

namespace patchmill {

// How an open spline ends; natural (without curvature) if nothing is given.
struct SplineEnd {
  // Along the spline, of any length but 0. The length of the derivative is found so that the middle of the
  // span at the end comes nearest to the circle that leaves the end in this direction [curves (33), (34)].
  // The angle between the direction and the chord is kMaxEndAngle at most.
  std::optional<Vec3> direction;
  // The curvature vector, 1/length [curves (35)]; its part along the spline is not used. Not together with
  // a direction.
  std::optional<Vec3> curvature;
};

inline constexpr double kMaxEndAngle = 2.0;  // rad

// The spline as SplineThrough gives it, open, with these ends. INVALID_ARGUMENT as there, and "start" or
// "end" for ends that contradict, have no direction, or cannot be met.
absl::StatusOr<std::vector<HermiteCurve>> SplineWithEnds(const std::vector<Vec3>& points,
                                                         const SplineEnd& start, const SplineEnd& end);

}  // namespace patchmill
