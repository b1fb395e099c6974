// Piecewise polynomial curves in Bezier form, made alike so that surfaces can be spanned between them.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/curve/curve.h"

namespace patchmill {

// Span k runs over [breaks[k], breaks[k+1]] with the points k*degree .. (k+1)*degree; neighbours share one.
struct BezierChain {
  int degree = 0;
  std::vector<double> breaks;  // 0 .. 1, increasing
  std::vector<Vec3> points;    // spans * degree + 1
  int spans() const { return static_cast<int>(breaks.size()) - 1; }
};

// Exact. INVALID_ARGUMENT for a B-spline that is not one (counts, knots that decrease or span nothing), that
// jumps (an inner knot more than `degree` times), and for a degree outside 1..kMaxBasisDegree.
absl::StatusOr<BezierChain> ChainOf(const Curve& curve);

// Breaks nearer than this to the next one count as one.
inline constexpr double kMinBreakGap = 1e-9;

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
