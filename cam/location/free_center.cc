#include "cam/location/free_center.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cam/location/ray_distance.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kClear = 1e-7;     // mm; distance kept from everything, for rounding
constexpr double kAccuracy = 1e-8;  // mm; of the distance to obstacles
constexpr int kMostObstacles = 24;
constexpr double kWedged = 0.95;  // share of the gouge by which obstacles yield
constexpr int kMostBeyond = 3;    // further obstacles considered once a centre that gouges is known

// All x with normal . x >= offset.
struct HalfSpace {
  Vec3 normal;
  double offset = 0.0;
};

// The point of all half-spaces nearest to p, by Hildreth's method [references: hildreth1957]. After the last
// sweep it is only close to that point.
Vec3 NearestIn(const std::vector<HalfSpace>& all, const Vec3& p) {
  constexpr int kSweeps = 200;
  std::vector<double> push(all.size(), 0.0);
  Vec3 x = p;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double moved = 0.0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double more = std::max(-push[k], all[k].offset - all[k].normal.dot(x));
      push[k] += more;
      x += more * all[k].normal;
      moved = std::max(moved, std::abs(more));
    }
    if (moved < 0.01 * kClear) break;
  }
  return x;
}

}  // namespace

std::optional<Vec3> FreeCenterNear(const Locator& locator, const Vec3& p, const Vec3& n,
                                   const FreeCenterLimits& limits) {
  const auto& [lowest_z, most, gouge, wedged] = limits;
  const double radius = locator.radius(), pushed = wedged ? radius - kWedged * gouge : radius + 2.0 * kClear;
  std::vector<HalfSpace> allowed = {{n, n.dot(p) + radius + kClear}};
  if (lowest_z > -kInfinity) allowed.push_back({Vec3::UnitZ(), lowest_z});
  std::optional<Vec3> near;
  for (int k = 0, last = kMostObstacles; k < last; ++k) {
    const Vec3 c = NearestIn(allowed, p);
    if ((c - p).norm() > radius + most) break;
    if (locator.Free(c)) return c;
    // An obstacle keeps the centre out of a ball that is swept downwards. The half-space beyond this ball is
    // free of it.
    const auto obstacle = ClosestToUpwardRay(locator.surface(), c, radius + kClear, kAccuracy);
    if (!obstacle) break;
    if (!near && obstacle->distance >= radius - gouge + kAccuracy) {
      if (wedged) return c;
      near = c;
      last = std::min(last, k + kMostBeyond);
    }
    const Vec3 away = internal::ToRay(obstacle->at.p, c);
    if (!(away.norm() > 0.0)) break;
    const Vec3 d = away.normalized();
    allowed.push_back({d, d.dot(obstacle->at.p) + pushed});
  }
  return near;
}

}  // namespace patchmill
