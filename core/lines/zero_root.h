// Finds a sign change of a field on a straight segment of a piece's parameters.
#pragma once

#include "core/lines/zero_field.h"

namespace patchmill {

inline double Value(const ZeroField& field, const Piece& piece, const Vec2& q) {
  return field.value(Evaluate(piece, q.x(), q.y()));
}

// A sign change of a function of t in [0,1], bracketed step by step: Illinois method, with halving where it
// stalls.
class ZeroBracket {
 public:
  // Takes the values at 0 and 1, which must differ in sign (zero counts as negative). `by_sign`: only the
  // signs of values are used.
  ZeroBracket(double at_0, double at_1, double enough, bool by_sign)
      : f_(at_0), g_(at_1), enough_(enough), by_sign_(by_sign) {}

  bool Open() const { return high_ - low_ > enough_ && steps_ < kMostSteps; }
  double Next() const;     // where to evaluate the function
  void Put(double value);  // the value at Next()
  double Middle() const { return 0.5 * (low_ + high_); }

 private:
  static constexpr int kMostSteps = 80, kPatience = 2;
  double low_ = 0.0, high_ = 1.0, f_, g_;
  double enough_;
  bool by_sign_;
  double halved_ = 1.0;  // width when the bracket was last halved
  int waited_ = 0, side_ = 0, steps_ = 0;
};

// A straight segment in the parameters of a piece, with the values of a field at its ends. They differ in
// sign (zero counts as negative).
struct ZeroInterval {
  Vec2 from, to;
  double at_from = 0.0, at_to = 0.0;
};

// The parameter t in [0,1] of a sign change on the interval. Smooth fields are solved to 1e-13, in about 8
// steps, others to `enough` (a share of the segment).
double ZeroBetween(const ZeroField& field, const Piece& piece, const ZeroInterval& interval, double enough);
// The value of `enough` for a segment of this length (mm).
double EnoughFor(const ZeroField& field, double length);

}  // namespace patchmill
