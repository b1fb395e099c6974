// Incremental evaluation of a cubic by three additions per step, in exact integers [curves, section 7].
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "core/curve/curve.h"

namespace patchmill {

// x(t) = a t + b t^2 + c t^3 in integer units, stepped by 2^-n [curves (31)-(32)]. Registers are scaled by
// 2^(3n), so every step is exact: value() / 2^(3n) = x(i 2^-n) without any rounding.
class CubicStepper {
 public:
  // INVALID_ARGUMENT unless n is in 0..16 and 8 (|a| + |b| + |c|) 2^(3n) < 2^62, so that every register fits
  // into 64 bits.
  static absl::StatusOr<CubicStepper> Make(int n, std::int64_t a, std::int64_t b, std::int64_t c);

  void Step();                                // uses the old values: R += A, then A += B, then B += C
  std::int64_t value() const { return r_; }   // 2^(3n) x
  std::int64_t first() const { return a_; }   // register A
  std::int64_t second() const { return b_; }  // register B
  std::int64_t third() const { return c_; }   // register C
  std::int64_t whole() const { return r_ >> (3 * n_); }  // floor(x): the sum of unit pulses so far

 private:
  CubicStepper(int n, std::int64_t a, std::int64_t b, std::int64_t c) : n_(n), a_(a), b_(b), c_(c) {}
  int n_ = 0;
  std::int64_t r_ = 0, a_ = 0, b_ = 0, c_ = 0;
};

// The 2^n + 1 points of a cubic at t = i 2^-n, each coordinate a whole number of `unit` (> 0) from the start.
// The three coefficients of each coordinate are rounded to whole units. Their sum is exact and then rounded
// down to whole units. So every coordinate lies within kForwardDifferenceError units of the curve.
// INVALID_ARGUMENT as CubicStepper.
inline constexpr double kForwardDifferenceError = 2.5;
absl::StatusOr<std::vector<std::array<std::int64_t, 3>>> ForwardDifferences(const HermiteCurve& curve, int n,
                                                                            double unit);

}  // namespace patchmill
