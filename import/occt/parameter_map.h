// How a parameter of a curve or surface as Open CASCADE has it becomes one of the rational spline made of it.
#pragma once

#include <algorithm>
#include <cmath>

namespace patchmill {

// The spline's knots stand at the curve's own parameters plus `shift`, so that only the places inside of a
// span have to be mapped: arcs of circles and hyperbolas run unevenly as rational quadratics.
struct ParameterMap {
  enum class Kind { kShift, kCircular, kHyperbolic };
  Kind kind = Kind::kShift;
  double first = 0.0, last = 1.0;  // of the curve's own parameter; first < last
  int spans = 1;                   // of equal length; only for arcs
  double shift = 0.0;

  // The spline's parameter; what lies outside of [first, last] is drawn to its ends.
  double operator()(double t) const {
    const double inside = std::clamp(t, first, last);
    if (kind == Kind::kShift) return inside + shift;
    const double step = (last - first) / spans;
    const double span = std::min(std::floor((inside - first) / step), spans - 1.0);
    const double from = first + span * step;
    const double before = std::max(inside - from, 0.0), after = std::max(from + step - inside, 0.0);
    // A rational quadratic with the weights 1, cos (or cosh) of half the step, 1 is symmetric, and its
    // parameter divides the span as these two chords do.
    const bool circular = kind == Kind::kCircular;
    const double a = circular ? std::sin(0.5 * before) : std::sinh(0.5 * before);
    const double b = circular ? std::sin(0.5 * after) : std::sinh(0.5 * after);
    return from + step * (a / (a + b)) + shift;
  }
};

}  // namespace patchmill
