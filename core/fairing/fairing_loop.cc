#include "core/fairing/fairing_loop.h"

#include <algorithm>

namespace patchmill {

FairingLimits MakeLimits(std::vector<Vec3> given, const FairingTerms& terms, const std::vector<bool>& fixed) {
  FairingLimits limits;
  const Axes frozen{!terms.axes[0], !terms.axes[1], !terms.axes[2]};
  limits.locked.assign(given.size(), frozen);
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (fixed[i]) limits.locked[i] = {true, true, true};
  }
  limits.given = std::move(given);
  limits.band = terms.band;
  limits.rule = terms.band_rule;
  return limits;
}

void FairingLimits::Lock(int node, const Axes& axes) {
  Axes& own = locked[static_cast<std::size_t>(node)];
  for (std::size_t a = 0; a < 3; ++a) own[a] = own[a] || axes[a];
}

void FairingLimits::SetBounds(int axis, const std::vector<Vec3>& points, BoxQuadratic& f) const {
  f.lower.assign(points.size(), 0.0);
  f.upper.assign(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (locked[i][static_cast<std::size_t>(axis)]) continue;
    const double from_given = points[i][axis] - given[i][axis];
    const double reach = rule == BandRule::kCut ? kInfinity : band[axis];
    f.lower[i] = std::min(0.0, -reach - from_given);
    f.upper[i] = std::max(0.0, reach - from_given);
  }
}

std::vector<Vec3> FairingLimits::Part(double share, const std::vector<Vec3>& from,
                                      const std::vector<Vec3>& to) const {
  std::vector<Vec3> points = from;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      if (locked[i][static_cast<std::size_t>(axis)]) continue;
      const double step = share * (to[i][axis] - from[i][axis]);
      points[i][axis] =
          std::clamp(from[i][axis] + step, given[i][axis] - band[axis], given[i][axis] + band[axis]);
    }
  }
  return points;
}

}  // namespace patchmill
