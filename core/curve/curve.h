// Curves of one parameter t in [0,1]: a closed set, polynomial or piecewise polynomial, in the caller's unit
// of length.
#pragma once

#include <variant>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/vec.h"
#include "core/math/bernstein.h"

namespace patchmill {

// Cubic given by its ends and its TRUE end derivatives [curves (2)]: C'(0) = d0, C'(1) = d1. An outgoing
// tangent T2 at the far end is -d1.
struct HermiteCurve {
  Vec3 p0 = Vec3::Zero(), d0 = Vec3::Zero(), p1 = Vec3::Zero(), d1 = Vec3::Zero();
};

// points.size() = degree + 1 in 2..kMaxBasisDegree + 1.
struct BezierCurve {
  std::vector<Vec3> points;
  int degree() const { return static_cast<int>(points.size()) - 1; }
};

// points.size() = knots.size() - degree - 1; the domain [knots[degree], knots[n]] is mapped to [0,1].
struct BsplineCurve {
  int degree = 0;  // 1..kMaxBasisDegree
  std::vector<double> knots;
  std::vector<Vec3> points;
};

// Hosaka's segment [curves (9)]: R(t) = origin + A f + B g + C h + D(t), a cubic Hermite curve with chord A,
// true end derivatives B and C, and the extra term D(t) = t^2 (t-1)^2 sum_i extra[i] t^i [curves (10)], which
// moves neither ends nor end derivatives. extra.size() <= 11.
struct HosakaSegment {
  Vec3 origin = Vec3::Zero();
  Vec3 a = Vec3::Zero(), b = Vec3::Zero(), c = Vec3::Zero();
  std::vector<Vec3> extra;
};

using Curve = std::variant<HermiteCurve, BezierCurve, BsplineCurve, HosakaSegment>;

// Value and derivatives with respect to t.
struct CurveJet {
  Vec3 p = Vec3::Zero(), d = Vec3::Zero(), dd = Vec3::Zero();
};

// Error about 1e-15 of the control points' size; t outside [0,1] extrapolates.
CurveJet Evaluate(const HermiteCurve& curve, double t);
CurveJet Evaluate(const BezierCurve& curve, double t);
CurveJet Evaluate(const BsplineCurve& curve, double t);
CurveJet Evaluate(const HosakaSegment& curve, double t);
CurveJet Evaluate(const Curve& curve, double t);

// The same curve in the opposite direction.
HermiteCurve Reversed(const HermiteCurve& curve);
BezierCurve Reversed(BezierCurve curve);

// The part [t1,t2] as a curve of its own [curves (11)]: its chord, and (t2-t1) times the derivatives. Exact.
HermiteCurve Part(const HermiteCurve& curve, double t1, double t2);
// The part [t1,t2] of a Bezier curve, 0 <= t1 < t2 <= 1. Ends at 0 and 1 are copied without rounding.
BezierCurve Part(BezierCurve curve, double t1, double t2);

// The cubic with the same ends and end derivatives.
HermiteCurve HermiteOf(const BezierCurve& curve);

// The exact Bezier form. INVALID_ARGUMENT for a B-spline of more than one span (it has no single polynomial)
// and for a form of degree above kMaxBasisDegree.
BezierCurve ToBezier(const HermiteCurve& curve);
absl::StatusOr<BezierCurve> ToBezier(const Curve& curve);

// The same curve with degree raised to `degree` (>= its own, <= kMaxBasisDegree).
BezierCurve Elevated(BezierCurve curve, int degree);

}  // namespace patchmill
