// The shape of a zig-zag line in plan: y over t, in the frame of the lines.
#pragma once

#include <vector>

namespace patchmill {

// The line is straight between knots, which lie `spacing` apart from t = begin on. It is level before the
// first and beyond the last one; with one knot it is straight. Lines of one family share their knots.
struct LineShape {
  double begin = 0.0, spacing = 1.0;  // mm
  std::vector<double> y = {0.0};      // mm, at the knots

  static LineShape Straight(double y) { return {.y = {y}}; }

  bool straight() const { return y.size() == 1; }
  double At(double t) const;
  double SlopeAt(double t) const;  // dy/dt; at a knot that of the stretch behind it
};

// Returns the line that divides the way from a to b: share 0 is a, 1 is b. Their knots are the same, or one
// of them is straight.
LineShape Between(const LineShape& a, const LineShape& b, double share);

// Returns t0, t1 (t0 < t1) and the knots between them at which the slope changes by more than 1e-6.
std::vector<double> CornersOf(const LineShape& line, double t0, double t1);

}  // namespace patchmill
