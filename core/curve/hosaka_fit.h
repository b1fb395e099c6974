// Shape of Hosaka's segment in its own axes, and fits of its end derivatives [curves, section 4].
//
// Own axes [curves (12)]: start at the origin, x along the chord A, z along A x B, y = z x x; so A =
// (chord,0,0), B = (bx,by,0), C = (cx,cy,cz). Angles are signed, from the x axis, radians.
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

// Parameter at which the xy view crosses the chord [curves (13)], strictly inside (0,1); nothing when it does
// not.
std::optional<double> ChordCrossing(double by, double cy);

// The double point of the xy view [curves (14), (15)]: both parameters in [0,1], ascending; nothing without a
// loop. Equal parameters: a cusp.
std::optional<std::pair<double, double>> FindLoop(double chord, const Vec2& b, const Vec2& c);
// The same of a cubic in space, seen across its chord and the end tangent that leaves the chord most; nothing
// for a straight one and without a chord.
std::optional<std::pair<double, double>> FindLoop(const HermiteCurve& curve);

// Unknown lengths of B and C, known unit directions, that lead the segment where it is wanted.
struct HosakaFit {
  double t = 0.0;           // where the condition holds
  double b = 0.0, c = 0.0;  // |B|, |C| > 0
};

// Through the point of space q, q.z != 0 [curves (18), (19)]. `b` lies in the xy plane with b.y != 0, c.z !=
// 0. INVALID_ARGUMENT when there is no solution in (0,1) with positive lengths.
absl::StatusOr<HosakaFit> FitThroughPoint(double chord, const Vec3& b, const Vec3& c, const Vec3& q);
// Largest |z| (reached at t = 2/3) is `z`, with ordinate `y` there [curves (20)].
absl::StatusOr<HosakaFit> FitPeak(double chord, const Vec3& b, const Vec3& c, double y, double z);

// Plane curves: through (x,y) with tangent at angle theta [curves (21)-(23)]; beta, gamma: angles of B and C.
// All solutions in (0,1) with positive lengths, by t; empty when there is none. INVALID_ARGUMENT for beta =
// gamma.
absl::StatusOr<std::vector<HosakaFit>> FitSlope(double chord, double beta, double gamma, const Vec2& q,
                                                double theta);
// The coefficients a3..a0 of [curves (21)], multiplied by cos(theta) so that a vertical tangent is no
// exception.
std::array<double, 4> SlopeCubic(double chord, double beta, double gamma, const Vec2& q, double theta);
// With an extremum of y at q: theta = 0 [curves (21)].
absl::StatusOr<std::vector<HosakaFit>> FitExtremum(double chord, double beta, double gamma, const Vec2& q);

// Extra term d0 + d1 t of one coordinate that gives it the value y and derivative dy at t in (0,1), t != 0, 1
// [curves (17)]. `without`: value and derivative of the coordinate without extra term.
struct ExtraTerm {
  double d0 = 0.0, d1 = 0.0;
};
ExtraTerm FitExtraTerm(double t, double y, double dy, double y_without, double dy_without);
// Space curve: the constant term d0 with d0.x = 0 that leads y and z of R(2/3) to the given values (own
// axes).
Vec3 FitExtraAtPeak(const HosakaSegment& segment, double y, double z);

// Roots of a3 t^3 + a2 t^2 + a1 t + a0 strictly inside (0,1), ascending; a double root counts once. Found
// between the extrema by bisection to the last bit.
std::vector<double> RootsInUnitInterval(const std::array<double, 4>& a3_to_a0);

}  // namespace patchmill
