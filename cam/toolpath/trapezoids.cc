#include "cam/toolpath/trapezoids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/status.h"

namespace patchmill {
namespace {

// The time over a stretch that begins and ends with these speeds, which its acceleration allows.
double TimeOver(const Stretch& s, double from, double to) {
  // The speed at the top of a triangle; the stretch's own limit cuts it to a trapezoid.
  const double top = std::min(s.speed, std::sqrt(s.acceleration * s.length + 0.5 * (from * from + to * to)));
  const double ramps = (top - from) + (top - to);
  const double ramps_length = (2.0 * top * top - from * from - to * to) / (2.0 * s.acceleration);
  return ramps / s.acceleration + std::max(0.0, s.length - ramps_length) / top;
}

}  // namespace

std::vector<double> TrapezoidTimes(std::span<const Stretch> stretches, std::vector<double> corners) {
  PM_CHECK(corners.size() == stretches.size() + 1);
  const auto reachable = [](const Stretch& s, double from) {
    return std::sqrt(from * from + 2.0 * s.acceleration * s.length);
  };
  for (std::size_t k = stretches.size(); k-- > 0;)
    corners[k] = std::min({corners[k], stretches[k].speed, reachable(stretches[k], corners[k + 1])});
  std::vector<double> times(stretches.size());
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    corners[k + 1] = std::min({corners[k + 1], stretches[k].speed, reachable(stretches[k], corners[k])});
    times[k] = TimeOver(stretches[k], corners[k], corners[k + 1]);
  }
  return times;
}

}  // namespace patchmill
