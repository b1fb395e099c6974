// End tangents of an edge curve from normals (FMILL), arcs or ellipses [curves, section 5].
//
// All tangents are OUTGOING: t1 at p1 towards p2, t2 at p2 towards p1. The curve is the cubic with C'(0) =
// t1, C'(1) = -t2.
#pragma once

#include <absl/status/statusor.h>

#include "core/curve/curve.h"

namespace patchmill {

struct EdgeTangents {
  Vec3 t1 = Vec3::Zero(), t2 = Vec3::Zero();
};

// If its projection into the tangent plane is shorter than this share of the chord, it has no direction.
inline constexpr double kMinProjection = 1e-9;

// FMILL [curves (26), (27)]: at each end the chord is projected into the tangent plane and made gamma times
// as long as the chord. n1, n2: unit normals. gamma in (0, 10]. INVALID_ARGUMENT when p1 = p2, when the chord
// is parallel to a normal (the direction is undefined: give the tangent), and for a gamma outside its range.
absl::StatusOr<EdgeTangents> FmillTangents(const Vec3& p1, const Vec3& n1, const Vec3& p2, const Vec3& n2,
                                           double gamma = 1.0);

// The FMILL tangent at one end: `chord` (from this end to the other) is projected into the plane across
// `normal` and made gamma |chord| long.
absl::StatusOr<Vec3> FmillTangent(const Vec3& chord, const Vec3& normal, double gamma = 1.0);

// Length of both end tangents of the cubic nearest to an arc: 4 R tan(angle/4) = chord 2 tan(angle/4) /
// sin(angle/2). The cubic meets the arc at both ends and in the middle. Its radius is too large by at most
// 2.8e-4 at 90 degrees. chord > 0; angle of the arc in (0, 2 pi).
double ArcTangentLength(double chord, double angle);

// Tangents of the quarter ellipse that leaves p1 along `direction1` and p2 along `direction2`, both towards
// the point where the two lines meet. Each is 4 (sqrt 2 - 1) times the vector to that point. INVALID_ARGUMENT
// when the lines do not meet ahead of both ends (parallel, behind, or farther apart than 1e-6 of the chord).
absl::StatusOr<EdgeTangents> QuarterEllipseTangents(const Vec3& p1, const Vec3& direction1, const Vec3& p2,
                                                    const Vec3& direction2);

inline HermiteCurve EdgeCurve(const Vec3& p1, const Vec3& p2, const EdgeTangents& t) {
  return {p1, t.t1, p2, -t.t2};
}

}  // namespace patchmill
