#include "core/curve/forward_differences.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {

absl::StatusOr<CubicStepper> CubicStepper::Make(int n, std::int64_t a, std::int64_t b, std::int64_t c) {
  if (n < 0 || n > 16) return absl::InvalidArgumentError(fmt::format("n = {}; must be in [0, 16]", n));
  // Bounds x on [0,1] and, with room to spare, every register: A, B and C are differences of x over a step.
  const double largest = 8.0 * (std::abs(static_cast<double>(a)) + std::abs(static_cast<double>(b)) +
                                std::abs(static_cast<double>(c)));
  if (std::ldexp(largest, 3 * n) >= std::ldexp(1.0, 62)) {
    return absl::InvalidArgumentError(fmt::format(
        "steps of 2^-{} of a cubic with coefficients up to {:g} do not fit into 64 bits", n, largest / 8.0));
  }
  const auto scaled = [](std::int64_t x, int bits) { return x * (std::int64_t{1} << bits); };
  return CubicStepper(n, scaled(a, 2 * n) + scaled(b, n) + c, scaled(2 * b, n) + 6 * c, 6 * c);
}

void CubicStepper::Step() {
  r_ += a_;
  a_ += b_;
  b_ += c_;
}

absl::StatusOr<std::vector<std::array<std::int64_t, 3>>> ForwardDifferences(const HermiteCurve& curve, int n,
                                                                            double unit) {
  if (!(unit > 0.0)) return absl::InvalidArgumentError(fmt::format("unit = {:g}; must be > 0", unit));
  if (n < 0 || n > 16) return absl::InvalidArgumentError(fmt::format("n = {}; must be in [0, 16]", n));
  std::vector<std::array<std::int64_t, 3>> points((std::size_t{1} << n) + 1);
  const Vec3 chord = (curve.p1 - curve.p0) / unit, b = curve.d0 / unit, c = curve.d1 / unit;
  const Vec3 second = 3.0 * chord - 2.0 * b - c, third = -2.0 * chord + b + c;  // [curves (30)]
  for (int axis = 0; axis < 3; ++axis) {
    for (const double x : {b[axis], second[axis], third[axis]}) {
      if (!(std::abs(x) < 1e15)) {
        return absl::InvalidArgumentError(fmt::format("unit = {:g} is too fine for this curve", unit));
      }
    }
    PM_ASSIGN_OR_RETURN(
        CubicStepper stepper,
        CubicStepper::Make(n, std::llround(b[axis]), std::llround(second[axis]), std::llround(third[axis])));
    for (auto& point : points) {
      point[static_cast<std::size_t>(axis)] = stepper.whole();
      stepper.Step();
    }
  }
  return points;
}

}  // namespace patchmill
