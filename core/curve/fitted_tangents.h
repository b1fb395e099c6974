// End tangents of a cubic edge whose directions are known and whose lengths are not. They are those of arcs
// [curves (24)] or of the fits of Hosaka's segment [curves, section 4].
#pragma once

#include <optional>

#include <absl/status/statusor.h>

#include "core/curve/edge_tangents.h"

namespace patchmill {

// Both ends with their unit tangent directions, OUTGOING as in edge_tangents.h.
struct EdgeDirections {
  Vec3 p1 = Vec3::Zero(), u1 = Vec3::Zero();
  Vec3 p2 = Vec3::Zero(), u2 = Vec3::Zero();
};

// In a fit of plane curves, directions and points may leave the plane by at most this share of the chord.
inline constexpr double kMaxOutOfPlane = 1e-6;

// Tangents of ArcTangentLength for the angle by which the curve turns: the sum of the angles between the
// chord and the two directions. For an arc, the curve is that arc to 2.8e-4 of its radius at 90 degrees.
// INVALID_ARGUMENT where the angle is 2 pi or the ends coincide.
absl::StatusOr<EdgeTangents> ArcTangents(const EdgeDirections& ends);

// The segment passes through a point in space [curves (18), (19)]. INVALID_ARGUMENT as FitThroughPoint.
absl::StatusOr<EdgeTangents> TangentsThroughPoint(const EdgeDirections& ends, const Vec3& point);

// The largest distance of the segment from the plane of its chord and first direction is that of `peak`
// [curves (20)]. At that place it is also as far from the chord, within the plane, as `peak` is. The place of
// `peak` along the chord does not matter.
absl::StatusOr<EdgeTangents> TangentsWithPeak(const EdgeDirections& ends, const Vec3& peak);

// Plane curves. The curve passes through `point` with the tangent along `direction` [curves (21)-(23)], of
// either sense. Without a direction the tangent there is along the chord, so that the curve is farthest from
// the chord there [curves (21)]. Of several solutions it is the one whose longer tangent is shortest.
// INVALID_ARGUMENT where directions, point and chord do not lie in one plane to kMaxOutOfPlane, for parallel
// directions, and where there is no solution in (0, 1) with positive lengths.
absl::StatusOr<EdgeTangents> TangentsWithSlope(const EdgeDirections& ends, const Vec3& point,
                                               const std::optional<Vec3>& direction);

// The same curve plus the extra term [curves (16), (17)] that leads it through `point` at t in (0,1), with
// `derivative` there if it is given. Ends and end derivatives stay. The degree is 4, with a derivative 5.
HosakaSegment LedThrough(const HermiteCurve& curve, double t, const Vec3& point,
                         const std::optional<Vec3>& derivative);

}  // namespace patchmill
