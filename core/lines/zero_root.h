// A sign change of a field on a straight segment of a piece's parameters.
#pragma once

#include <algorithm>

#include "core/lines/zero_field.h"

namespace patchmill {

inline double Value(const ZeroField& field, const Piece& piece, const Vec2& q) {
  return field.value(Evaluate(piece, q.x(), q.y()));
}

// The parameter t in [0,1] of a sign change between `from` and `to`, whose values differ in sign (zero counts
// as negative). Smooth fields: to 1e-13 by Illinois steps, halved where they stall, about 8 in all; others by
// halving to `stop` (a share of the segment).
inline double ZeroBetween(const ZeroField& field, const Piece& piece, const Vec2& from, const Vec2& to,
                          double at_from, double at_to, double stop) {
  constexpr double kExact = 1e-13;
  constexpr int kMostSteps = 80, kPatience = 3;
  const double enough = field.smooth ? kExact : std::max(stop, kExact);
  double low = 0.0, high = 1.0, f = at_from, g = at_to;
  double halved = 1.0;  // width when the bracket was last halved
  int waited = 0, side = 0;
  for (int i = 0; i < kMostSteps && high - low > enough; ++i) {
    double t = 0.5 * (low + high);
    if (field.smooth && waited < kPatience && f != g) {
      // Steps stop short of the ends by half of what is enough: then one more from the other side ends it.
      const double margin = 0.5 * enough;
      t = std::clamp((low * g - high * f) / (g - f), low + margin, high - margin);
    }
    const double x = Value(field, piece, from + t * (to - from));
    const bool below = (x > 0.0) == (at_from > 0.0);
    (below ? low : high) = t;
    (below ? f : g) = x;
    if (side == (below ? -1 : 1)) (below ? g : f) *= 0.5;  // Illinois: the end that stays counts half
    side = below ? -1 : 1;
    waited = high - low <= 0.5 * halved || waited == kPatience ? 0 : waited + 1;
    if (waited == 0) halved = high - low;
  }
  return 0.5 * (low + high);
}

}  // namespace patchmill
