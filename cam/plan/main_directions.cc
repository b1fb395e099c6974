#include "cam/plan/main_directions.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patchmill {
namespace {

constexpr int kBins = 96;
constexpr double kBin = kPi / kBins, kNear = 2.0 * kBin, kApart = kPi / 12.0;
constexpr double kShare = 0.1;

}  // namespace

double AsDirection(double angle) { return std::fmod(std::fmod(angle, kPi) + kPi, kPi); }

double DirectionsApart(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, kPi - d);
}

std::vector<double> MainDirections(std::span<const Vec2> steps, int count) {
  struct Step {
    Vec2 way;
    double direction = 0.0, length = 0.0;
  };
  std::vector<Step> left;
  double total = 0.0;
  for (const Vec2& step : steps) {
    left.push_back({step, AsDirection(std::atan2(step.y(), step.x())), step.norm()});
    total += left.back().length;
  }
  std::vector<double> found;
  while (found.size() < static_cast<std::size_t>(count)) {
    std::array<double, kBins> length{};
    for (const Step& step : left)
      length[static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>(step.direction / kBin)))] +=
          step.length;
    // Two bins together: a direction may lie where they meet.
    const auto pair = [&](int k) {
      return length[static_cast<std::size_t>(k)] + length[static_cast<std::size_t>((k + 1) % kBins)];
    };
    int most = 0;
    for (int k = 1; k < kBins; ++k) {
      if (pair(k) > pair(most)) most = k;
    }
    double middle = AsDirection((most + 1) * kBin);
    // The sum of all that is near, there and back: what they deviate by cancels. Nearer and nearer, for a
    // step around a corner does not.
    double near = 0.0;
    for (const double within : {kNear, 0.5 * kNear, 0.25 * kNear}) {
      const Vec2 along(std::cos(middle), std::sin(middle));
      Vec2 way = Vec2::Zero();
      double length_of_them = 0.0;
      for (const Step& step : left) {
        if (DirectionsApart(step.direction, middle) > within) continue;
        length_of_them += step.length;
        way += step.way.dot(along) < 0.0 ? Vec2(-step.way) : step.way;
      }
      if (within == kNear) near = length_of_them;
      if (length_of_them > 0.0) middle = AsDirection(std::atan2(way.y(), way.x()));
    }
    if (!(near > kShare * total)) break;
    found.push_back(middle);
    std::erase_if(left,
                  [&](const Step& step) { return DirectionsApart(step.direction, found.back()) < kApart; });
  }
  return found;
}

}  // namespace patchmill
