// Integrals over triangles of a piece's parameters.
#pragma once

#include "core/base/vec.h"

namespace patchmill {

// Calls visit(q, weight) at the 7 points of the symmetric rule of degree 5 [references: radon1948] on the
// triangle a b c; the weights sum to its signed area, positive when counter-clockwise.
template <class Visit>
void ForQuadraturePoints(const Vec2& a, const Vec2& b, const Vec2& c, Visit&& visit) {
  constexpr double kCenter = 0.225;
  constexpr double kNear[2] = {0.470142064105115090, 0.101286507323456339};  // share of two of the corners
  constexpr double kWeight[2] = {0.132394152788506181, 0.125939180544827153};
  const double area = 0.5 * Cross(b - a, c - a);
  visit(Vec2((a + b + c) / 3.0), kCenter * area);
  for (int k = 0; k < 2; ++k) {
    const double s = kNear[k], t = 1.0 - 2.0 * s;
    visit(Vec2(t * a + s * b + s * c), kWeight[k] * area);
    visit(Vec2(s * a + t * b + s * c), kWeight[k] * area);
    visit(Vec2(s * a + s * b + t * c), kWeight[k] * area);
  }
}

}  // namespace patchmill
