#include "cam/path/stepover/step_over.h"

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

namespace patchmill {
namespace {

// asin(x) / x and sin(x) / x without cancellation at 0.
double AsinRatio(double x) { return x < 1e-4 ? 1.0 + x * x / 6.0 : std::asin(x) / x; }
double SinRatio(double x) { return x < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x; }

}  // namespace

// Here A = a, B = b, s = scallop, R = radius. Let 2 alpha be the angle between two neighbouring centres on
// the centres' circle, whose radius is A / |kappa|. Then x = sin(alpha / 2) by [spacing (2)], and w_c is the
// arc 2 alpha A / |kappa|.
double CenterStep(double radius, double scallop, double kappa) {
  const double a = 1.0 - kappa * radius;
  if (!(a > 0.0)) return 0.0;
  const double b = 1.0 - kappa * scallop;
  const double m = std::sqrt(scallop * (2.0 * radius - scallop));
  const double x = 0.5 * std::abs(kappa) * m / std::sqrt(a * b);
  // A narrow bore: one pass leaves no more than the scallop all around. The step is the whole circumference.
  if (x >= 1.0) return 2.0 * kPi * a / std::abs(kappa);
  return 2.0 * m * std::sqrt(a / b) * AsinRatio(x);
}

double ScallopOfStep(double radius, double center_step, double kappa) {
  const double a = 1.0 - kappa * radius;
  if (!(a > 0.0)) return 0.0;
  const double half_alpha = std::min(0.25 * std::abs(kappa) * center_step / a, 0.5 * kPi);
  const double half_chord = half_alpha < 0.5 * kPi || kappa == 0.0 ? 0.5 * center_step * SinRatio(half_alpha)
                                                                   : 2.0 * a / std::abs(kappa);
  // The smaller root s of s^2 - (2 R + t kappa) s + t = 0 [spacing (5)].
  const double t = half_chord * half_chord / a;
  const double p = 2.0 * radius + t * kappa;
  const double discriminant = p * p - 4.0 * t;
  if (discriminant < 0.0 || p < 0.0) return kInfinity;
  return 2.0 * t / (p + std::sqrt(discriminant));
}

int PartsOfGap(double gap, double need, double least) {
  constexpr double kSlack = 1e-9;  // of a part: a gap that was made to fit does fit despite rounding
  const double parts = need >= least ? std::ceil(gap / need - kSlack) : std::floor(gap / least + kSlack);
  return static_cast<int>(std::max(1.0, parts));
}

double WideGap(double scallop, double chord_tolerance) {
  return std::min(kWideGap,
                  std::sqrt(1.0 + 0.5 * chord_tolerance / scallop));  // leftover grows with its square
}

}  // namespace patchmill
