#include "core/lines/zero_root.h"

#include <algorithm>

namespace patchmill {

double ZeroBracket::Next() const {
  if (by_sign_ || waited_ >= kPatience || f_ == g_) return Middle();
  // A field may be infinite or NaN where the parametrisation has no normal.
  const double t = (low_ * g_ - high_ * f_) / (g_ - f_);
  if (!(t >= low_ && t <= high_)) return Middle();
  // Steps stop short of the ends by a share of `enough_`. Then one more step from the other side ends the
  // search.
  const double margin = 0.45 * enough_;
  return std::clamp(t, low_ + margin, high_ - margin);
}

void ZeroBracket::Put(double value) {
  const double t = Next();
  const bool below = (value > 0.0) == (f_ > 0.0);
  (below ? low_ : high_) = t;
  (below ? f_ : g_) = value;
  if (side_ == (below ? -1 : 1)) (below ? g_ : f_) *= 0.5;  // Illinois: the end that stays counts half
  side_ = below ? -1 : 1;
  waited_ = high_ - low_ <= 0.5 * halved_ || waited_ == kPatience ? 0 : waited_ + 1;
  if (waited_ == 0) halved_ = high_ - low_;
  ++steps_;
}

double EnoughFor(const ZeroField& field, double length) {
  constexpr double kExact = 1e-13, kLeastLength = 1e-9;
  return field.smooth ? kExact : std::max(field.resolution / std::max(length, kLeastLength), kExact);
}

double ZeroBetween(const ZeroField& field, const Piece& piece, const ZeroInterval& interval, double enough) {
  const auto& [from, to, at_from, at_to] = interval;
  ZeroBracket bracket(at_from, at_to, enough, !field.smooth);
  while (bracket.Open()) bracket.Put(Value(field, piece, from + bracket.Next() * (to - from)));
  return bracket.Middle();
}

}  // namespace patchmill
