// A curve of a CAD edge as its Bezier spans: points, derivatives, and the parts between two parameters.
#pragma once

#include <vector>

#include "core/base/vec.h"
#include "core/brep/brep_model.h"

namespace patchmill {

// Homogeneous points (w x, w y, w z, w) of the part [from, to] of the curve, at least two.
struct CurveSpan {
  double from = 0.0, to = 1.0;
  std::vector<Vec4> points;
};

struct SpannedCurve {
  std::vector<CurveSpan> spans;  // in order; each begins where the one before ends

  double first() const { return spans.front().from; }
  double last() const { return spans.back().to; }
};

// The spans between distinct knots. Exact to about 1e-15 of the points' size. The curve must have points.
SpannedCurve SpansOf(const BrepCurve& curve);

struct SpacePoint {
  Vec3 p = Vec3::Zero();
  Vec3 d = Vec3::Zero();  // with respect to the curve's parameter
};
// At a parameter in [first, last]; outside, the first or the last span is extrapolated.
SpacePoint PointAt(const SpannedCurve& curve, double at);

}  // namespace patchmill
