// Piecewise polynomial curves in Bezier form, made alike so that surfaces can be spanned between them.
#pragma once

#include <array>
#include <vector>

#include <absl/status/statusor.h>

#include "core/curve/curve.h"

namespace patchmill {

// Breaks nearer than this to the next one count as one.
inline constexpr double kMinBreakGap = 1e-9;

// Span k runs over [breaks[k], breaks[k+1]] with the points k*degree .. (k+1)*degree; neighbours share one.
struct BezierChain {
  int degree = 0;
  std::vector<double> breaks;  // 0 .. 1, increasing
  std::vector<Vec3> points;    // spans * degree + 1
  int spans() const { return static_cast<int>(breaks.size()) - 1; }
};

BezierChain AsChain(BezierCurve curve);
BezierCurve SpanOf(const BezierChain& chain, int span);  // by its own parameter in [0,1]

// By the parameter of the whole; at a break the span after it.
CurveJet Evaluate(const BezierChain& chain, double t);
std::array<CurveJet, 2> JetsAtBreak(const BezierChain& chain,
                                    int k);        // before and after breaks[k], an inner one
HermiteCurve HermiteOf(const BezierChain& chain);  // the cubic with the same ends and end derivatives
BezierChain Reversed(BezierChain chain);
BezierChain Elevated(BezierChain chain, int degree);
// As Part of a curve; t2 - t1 > kMinBreakGap.
BezierChain Part(const BezierChain& chain, double t1, double t2);
// The breaks of all; of those that count as one the first.
std::vector<double> CommonBreaks(const std::vector<BezierChain>& chains);
// The same curve cut at `breaks`, too: 0 .. 1, all of its own among them, no two of which count as one.
BezierChain CutAt(BezierChain chain, const std::vector<double>& breaks);

// Exact. INVALID_ARGUMENT for a B-spline that is not one (counts, knots that decrease or span nothing), that
// jumps (an inner knot more than `degree` times), and for a degree outside 1..kMaxBasisDegree.
absl::StatusOr<BezierChain> ChainOf(const Curve& curve);

// Number of control points that each chain would have if all were made alike.
std::size_t AlikeSize(const std::vector<BezierChain>& chains);

// Gives all chains one degree, the highest, and one set of breaks, all of theirs. Exact to rounding.
// INVALID_ARGUMENT where two breaks of one chain count as one. Cost O(points made).
absl::Status MakeAlike(std::vector<BezierChain>& chains);

// Parameter values of the control points: those at which a linear function has its Bezier coefficients.
std::vector<double> ControlAbscissae(const BezierChain& chain);

// Knots of the chain as a B-spline: inner breaks `degree` times.
std::vector<double> ChainKnots(const BezierChain& chain);

}  // namespace patchmill
