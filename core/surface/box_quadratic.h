// The exact minimum of a quadratic of two variables over a box: one step of a bounded Newton method. (A step
// that is clamped variable by variable is not a descent step and crawls along the border;
// [location, section 7].)
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

namespace patchmill {

// Symmetric 2 x 2 matrix.
struct Sym2 {
  double uu = 0.0, uv = 0.0, vv = 0.0;
  double Determinant() const { return uu * vv - uv * uv; }
  bool PositiveDefinite() const { return uu > 0.0 && vv > 0.0 && Determinant() > 1e-14 * uu * vv; }
};

// Returns argmin of g.d + d.H d / 2 over low <= d <= high, with low <= 0 <= high. H may be any matrix: if it
// is not positive definite, the minimum lies on the border and is found there.
inline Vec2 MinimizeInBox(const Vec2& g, const Sym2& h, const Vec2& low, const Vec2& high) {
  if (h.PositiveDefinite()) {
    const double det = h.Determinant();
    const Vec2 d((h.uv * g.y() - h.vv * g.x()) / det, (h.uv * g.x() - h.uu * g.y()) / det);
    if (d.x() >= low.x() && d.x() <= high.x() && d.y() >= low.y() && d.y() <= high.y()) return d;
  }
  const auto value = [&](double x, double y) {
    return g.x() * x + g.y() * y + 0.5 * (h.uu * x * x + h.vv * y * y) + h.uv * x * y;
  };
  Vec2 best = Vec2::Zero();
  double best_value = 0.0;
  const auto consider = [&](double x, double y) {
    const double f = value(x, y);
    if (f < best_value) {
      best_value = f;
      best = {x, y};
    }
  };
  for (const double x : {low.x(), high.x()}) {
    consider(x, low.y());
    consider(x, high.y());
    if (h.vv > 0.0) consider(x, std::clamp(-(g.y() + h.uv * x) / h.vv, low.y(), high.y()));
  }
  for (const double y : {low.y(), high.y()}) {
    if (h.uu > 0.0) consider(std::clamp(-(g.x() + h.uv * y) / h.uu, low.x(), high.x()), y);
  }
  return best;
}

}  // namespace patchmill
