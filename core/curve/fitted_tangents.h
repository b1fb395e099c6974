// End tangents of a cubic edge whose directions are known and whose lengths are not: arcs [curves (24)] and
// the fits of Hosaka's segment [curves, section 4].
#pragma once

#include <optional>

#include <absl/status/statusor.h>

#include "core/curve/edge_tangents.h"

namespace patchmill {

// Both ends with unit tangent directions, OUTGOING as in edge_tangents.h.
struct EdgeDirections {
  Vec3 p1 = Vec3::Zero(), u1 = Vec3::Zero();
  Vec3 p2 = Vec3::Zero(), u2 = Vec3::Zero();
};

// Largest share of the chord by which directions and points may leave the plane where a fit is one of plane
// curves.
inline constexpr double kMaxOutOfPlane = 1e-6;

// ArcTangentLength for the angle by which the curve turns, the sum of those between chord and directions: the
// arc itself to 2.8e-4 of its radius at 90 degrees. INVALID_ARGUMENT where that is 2 pi or the ends coincide.
absl::StatusOr<EdgeTangents> ArcTangents(const EdgeDirections& ends);

// The segment passes through a point of space [curves (18), (19)]. INVALID_ARGUMENT as FitThroughPoint.
absl::StatusOr<EdgeTangents> TangentsThroughPoint(const EdgeDirections& ends, const Vec3& point);

// The segment is farthest from the plane of its chord and first direction as far away as `peak` is
// [curves (20)]; there it lies as far from the chord, within that plane, as `peak`. The place of `peak` along
// the chord is free.
absl::StatusOr<EdgeTangents> TangentsWithPeak(const EdgeDirections& ends, const Vec3& peak);

// Plane curves: through `point` with the tangent along `direction` [curves (21)-(23)], of either sense;
// without one along the chord, so that the curve is farthest from it there [curves (21)]. Of several
// solutions the one whose longer tangent is shortest. INVALID_ARGUMENT where directions, point and chord lie
// in no plane to kMaxOutOfPlane, for parallel directions, and where there is no solution in (0, 1) with
// positive lengths.
absl::StatusOr<EdgeTangents> TangentsWithSlope(const EdgeDirections& ends, const Vec3& point,
                                               const std::optional<Vec3>& direction);

// The same curve with the extra term [curves (16), (17)] that leads it through `point` at t in (0,1), with
// the derivative given, if one is. Ends and end derivatives stay. Degree 4, with a derivative 5.
HosakaSegment LedThrough(const HermiteCurve& curve, double t, const Vec3& point,
                         const std::optional<Vec3>& derivative);

}  // namespace patchmill
