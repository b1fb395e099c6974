// Exact minimum of a quadratic of two variables over a rectangle.
#pragma once

#include <algorithm>

namespace patchmill {

// 1/2 (a x^2 + 2 b x y + c y^2) + gx x + gy y.
struct Quadratic2 {
  double a = 0.0, b = 0.0, c = 0.0;
  double gx = 0.0, gy = 0.0;
  double operator()(double x, double y) const {
    return x * (0.5 * a * x + b * y + gx) + y * (0.5 * c * y + gy);
  }
};

struct Box2 {
  double x0 = 0.0, x1 = 0.0, y0 = 0.0, y1 = 0.0;
};

struct BoxMinimum {
  double x = 0.0, y = 0.0;
  double value = 0.0;
};

namespace internal {
// Where 1/2 a t^2 + g t is smallest on [lo, hi].
inline double MinimumOnSegment(double a, double g, double lo, double hi) {
  if (a > 0.0) return std::clamp(-g / a, lo, hi);
  return lo * (0.5 * a * lo + g) <= hi * (0.5 * a * hi + g) ? lo : hi;
}
}  // namespace internal

// Needs x0 <= x1, y0 <= y1; f need not be convex. If there is no free minimum inside, the minimum lies on the
// border: each edge fixes one variable, the other is solved and clamped, and the best of the four is kept
// ([location, section 7]: clamping the free minimum component-wise is not a descent step).
inline BoxMinimum MinimizeOnBox(const Quadratic2& f, const Box2& box) {
  const double det = f.a * f.c - f.b * f.b;
  if (det > 0.0 && f.a > 0.0) {
    const double x = (f.b * f.gy - f.c * f.gx) / det, y = (f.b * f.gx - f.a * f.gy) / det;
    if (x >= box.x0 && x <= box.x1 && y >= box.y0 && y <= box.y1) return {x, y, f(x, y)};
  }
  BoxMinimum best;
  bool first = true;
  const auto take = [&](double x, double y) {
    const double value = f(x, y);
    if (first || value < best.value) best = {x, y, value};
    first = false;
  };
  for (const double x : {box.x0, box.x1}) {
    take(x, internal::MinimumOnSegment(f.c, f.b * x + f.gy, box.y0, box.y1));
  }
  for (const double y : {box.y0, box.y1}) {
    take(internal::MinimumOnSegment(f.a, f.b * y + f.gx, box.x0, box.x1), y);
  }
  return best;
}

}  // namespace patchmill
