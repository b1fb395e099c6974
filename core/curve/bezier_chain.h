// Piecewise polynomial curves in Bezier form. They can be made alike, so that a surface can span them.
#pragma once

#include <array>
#include <vector>

#include <absl/status/statusor.h>

#include "core/curve/curve.h"

namespace patchmill {

// Two neighbouring breaks nearer to each other than this count as one.
inline constexpr double kMinBreakGap = 1e-9;

// Span k covers [breaks[k], breaks[k+1]] with the points k*degree .. (k+1)*degree. Neighbours share a point.
struct BezierChain {
  int degree = 0;
  std::vector<double> breaks;  // 0 .. 1, increasing
  std::vector<Vec3> points;    // spans * degree + 1
  int spans() const { return static_cast<int>(breaks.size()) - 1; }
};

BezierChain AsChain(BezierCurve curve);
BezierCurve SpanOf(const BezierChain& chain, int span);  // over its own parameter in [0,1]

// t is the parameter of the whole chain. At a break the span after it counts.
CurveJet Evaluate(const BezierChain& chain, double t);
std::array<CurveJet, 2> JetsAtBreak(const BezierChain& chain,
                                    int k);        // before and after breaks[k], an inner one
HermiteCurve HermiteOf(const BezierChain& chain);  // the cubic with the same ends and end derivatives
BezierChain Reversed(BezierChain chain);
BezierChain Elevated(BezierChain chain, int degree);
// The part [t1,t2] as a chain of its own, as for a curve; t2 - t1 > kMinBreakGap.
BezierChain Part(const BezierChain& chain, double t1, double t2);
// The breaks of all chains together. Of several that count as one, the first is kept.
std::vector<double> CommonBreaks(const std::vector<BezierChain>& chains);
// The same curve, cut at `breaks` as well. These run from 0 to 1 and contain all breaks of the chain, of
// which no two may count as one.
BezierChain CutAt(BezierChain chain, const std::vector<double>& breaks);

// Exact. INVALID_ARGUMENT for an invalid B-spline (counts, knots that decrease or span nothing), for one that
// jumps (an inner knot more than `degree` times), and for a degree outside 1..kMaxBasisDegree.
absl::StatusOr<BezierChain> ChainOf(const Curve& curve);

// Number of control points that each chain would have if all were made alike.
std::size_t AlikeSize(const std::vector<BezierChain>& chains);

// Gives all chains the highest degree among them and all their breaks. Exact to rounding. INVALID_ARGUMENT
// where two breaks of one chain count as one. Cost O(points made).
absl::Status MakeAlike(std::vector<BezierChain>& chains);

// Parameters of the control points (Greville abscissae): the Bezier coefficients of the function f(t) = t.
std::vector<double> ControlAbscissae(const BezierChain& chain);

// Knot vector of the chain as a B-spline: each inner break `degree` times.
std::vector<double> ChainKnots(const BezierChain& chain);

}  // namespace patchmill
