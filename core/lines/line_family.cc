#include "core/lines/line_family.h"

#include <algorithm>
#include <cmath>

#include "core/lines/line_fields.h"

namespace patchmill {
namespace {

template <class... Fs>
struct Overloaded : Fs... {
  using Fs::operator()...;
};
template <class... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;  // clang 14 needs it

// The smallest number that is 1, 2 or 5 times a power of ten and at least x > 0.
double RoundStep(double x) {
  const double decade = std::pow(10.0, std::floor(std::log10(x)));
  for (const double m : {1.0, 2.0, 5.0}) {
    if (m * decade >= x * (1.0 - 1e-12)) return m * decade;
  }
  return 10.0 * decade;
}

// Multiples of the roundest step for which at most `count` of them lie strictly between low and high.
std::vector<double> RoundLevels(double low, double high, int count) {
  if (!(high - low > 1e-9 * std::max(std::abs(low), std::abs(high)))) return {};
  double step = RoundStep((high - low) / (count + 1));
  std::vector<double> levels;
  for (int tries = 0; tries < 4; ++tries, step = RoundStep(1.5 * step)) {
    levels.clear();
    const double first = std::floor(low / step) + 1.0;
    for (int k = 0; (first + k) * step < high; ++k) levels.push_back((first + k) * step);
    if (static_cast<int>(levels.size()) <= count) break;
  }
  return levels;
}

std::vector<double> Heights(const Surface& surface, const Vec3& axis, int count, const Vec3& origin) {
  double low = kInfinity, high = -kInfinity;
  for (const SurfaceLeaf& leaf : surface.leaves) {
    for (const double u : {leaf.u0, leaf.u1}) {
      for (const double v : {leaf.v0, leaf.v1}) {
        const double h = axis.dot(Position(surface.piece(leaf.piece), u, v));
        low = std::min(low, h);
        high = std::max(high, h);
      }
    }
  }
  const double zero = axis.dot(origin);
  std::vector<double> levels = RoundLevels(low - zero, high - zero, count);
  for (double& level : levels) level += zero;
  return levels;
}

// Every 90 / n degrees: n - 1 slopes, where n is the largest divisor of 90 that gives at most `count`.
std::vector<double> Slopes(int count) {
  int parts = 2;
  for (const int n : {2, 3, 6, 9, 10, 15, 18, 30, 45, 90}) {
    if (n - 1 <= count) parts = n;
  }
  std::vector<double> levels;
  for (int k = 1; k < parts; ++k) levels.push_back(Radians(90.0 * k / parts));
  return levels;
}

}  // namespace

bool HasLevels(const LineFamily& family) {
  return std::visit(
      Overloaded{[](const ContourLines&) { return true; }, [](const EquiSlopeLines&) { return true; },
                 [](const BrightnessLines&) { return true; }, [](const HighlightLines&) { return true; },
                 [](const auto&) { return false; }},
      family);
}

ZeroField FieldOf(const LineFamily& family, double level) {
  return std::visit(Overloaded{[&](const ContourLines& f) { return ContourField(level, f.axis); },
                               [&](const EquiSlopeLines& f) { return SlopeField(level, f.axis); },
                               [&](const BrightnessLines& f) { return BrightnessField(level, f.light); },
                               [&](const SilhouetteLines& f) { return SilhouetteField(f.view); },
                               [&](const EyeSilhouetteLines& f) { return EyeSilhouetteField(f.eye); },
                               [&](const HighlightLines& f) {
                                 const Vec3 across = Eigen::AngleAxisd(level, f.plane) * f.across;
                                 return HighlightField(f.plane, across);
                               },
                               [&](const ContourInflectionLines& f) { return ContourCurvatureField(f.axis); },
                               [&](const SlopeExtremumLines& f) { return SlopeExtremumField(f.axis); }},
                    family);
}

std::vector<double> ChooseLevels(const Surface& surface, const LineFamily& family, int count,
                                 const Vec3& origin) {
  return std::visit(Overloaded{[&](const ContourLines& f) { return Heights(surface, f.axis, count, origin); },
                               [&](const EquiSlopeLines&) { return Slopes(count); },
                               [&](const BrightnessLines&) {
                                 std::vector<double> levels;
                                 for (int k = 1; k <= count; ++k)
                                   levels.push_back(2.0 * k / (count + 1) - 1.0);
                                 return levels;
                               },
                               [&](const HighlightLines&) {
                                 std::vector<double> levels;
                                 for (int k = 0; k < count; ++k) levels.push_back(kPi * k / count);
                                 return levels;
                               },
                               [](const auto&) { return std::vector<double>(); }},
                    family);
}

}  // namespace patchmill
