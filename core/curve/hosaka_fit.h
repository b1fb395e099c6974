// Shape of Hosaka's segment in its own axes, and fits of its end derivatives [curves, section 4].
//
// Own axes [curves (12)]: start at the origin, x along the chord A, z along A x B, y = z x x. So A =
// (chord,0,0), B = (bx,by,0), C = (cx,cy,cz). Angles are signed, from the x axis, in radians.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "core/curve/curve.h"

namespace patchmill {

// The rotation into the own axes (rows x, y, z). INVALID_ARGUMENT when A is zero or B lies along A.
absl::StatusOr<Eigen::Matrix3d> HosakaAxes(const HosakaSegment& segment);

// Parameter at which the xy view crosses the chord [curves (13)], strictly inside (0,1); nullopt if it does
// not cross.
std::optional<double> ChordCrossing(double by, double cy);

// The double point of the xy view [curves (14), (15)]: both parameters in [0,1], ascending; nullopt if there
// is no loop. Equal parameters mean a cusp.
std::optional<std::pair<double, double>> FindLoop(double chord, const Vec2& b, const Vec2& c);
// The double point of a cubic in space, seen in the plane of its chord and of the end tangent that leaves the
// chord most. nullopt for a straight cubic and where the ends coincide.
std::optional<std::pair<double, double>> FindLoop(const HermiteCurve& curve);

// Lengths of B and C along given unit directions, such that the segment meets a condition.
struct HosakaFit {
  double t = 0.0;           // where the condition holds
  double b = 0.0, c = 0.0;  // |B|, |C| > 0
};

// The segment passes through the point q in space, q.z != 0 [curves (18), (19)]. `b` lies in the xy plane
// with b.y != 0, and c.z != 0. INVALID_ARGUMENT when there is no solution in (0,1) with positive lengths.
absl::StatusOr<HosakaFit> FitThroughPoint(double chord, const Vec3& b, const Vec3& c, const Vec3& q);
// The largest |z| (reached at t = 2/3) is `z`, with ordinate `y` there [curves (20)].
absl::StatusOr<HosakaFit> FitPeak(double chord, const Vec3& b, const Vec3& c, double y, double z);

// Plane curves: through q with the tangent at angle theta [curves (21)-(23)]; beta, gamma: angles of B and C.
// Returns all solutions in (0,1) with positive lengths, ordered by t; empty if there is none.
// INVALID_ARGUMENT for beta = gamma.
absl::StatusOr<std::vector<HosakaFit>> FitSlope(double chord, double beta, double gamma, const Vec2& q,
                                                double theta);
// The coefficients a3..a0 of [curves (21)], multiplied by cos(theta) so that a vertical tangent is no
// exception.
std::array<double, 4> SlopeCubic(double chord, double beta, double gamma, const Vec2& q, double theta);
// The curve has an extremum of y at q: theta = 0 [curves (21)].
absl::StatusOr<std::vector<HosakaFit>> FitExtremum(double chord, double beta, double gamma, const Vec2& q);

// Extra term d0 + d1 t of one coordinate that gives it the value y and the derivative dy at t in (0,1)
// [curves (17)]. y_without, dy_without: its value and derivative without the extra term.
struct ExtraTerm {
  double d0 = 0.0, d1 = 0.0;
};
ExtraTerm FitExtraTerm(double t, double y, double dy, double y_without, double dy_without);
// Space curve: the constant term d0 with d0.x = 0 that gives y and z of R(2/3) these values (own axes).
Vec3 FitExtraAtPeak(const HosakaSegment& segment, double y, double z);

// Roots of a3 t^3 + a2 t^2 + a1 t + a0 strictly inside (0,1), ascending; a double root counts once. They are
// found between the extrema by bisection to the last bit.
std::vector<double> RootsInUnitInterval(const std::array<double, 4>& a3_to_a0);

}  // namespace patchmill
