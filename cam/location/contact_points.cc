#include "cam/location/contact_points.h"

#include <algorithm>

#include "core/surface/closest.h"

namespace patchmill {
namespace {

// All lengths are in radii.
constexpr double kCertainty = 1e-4;
constexpr double kOff =
    0.05;  // how far from the known places the next is searched; it may be kOff^2 / 2 farther
constexpr double kMinSeparation = 0.1;
constexpr std::size_t kMost = 4;

}  // namespace

std::vector<SurfacePoint> ContactPoints(const Surface& surface, const Vec3& c, double radius, double slack) {
  std::vector<SurfacePoint> places;
  const auto nearest = ClosestToPoint(surface, c, kContactReach * radius, kCertainty * radius);
  if (!nearest) return places;
  places.push_back(nearest->at);
  const double least = (nearest->at.p - c).norm();
  while (places.size() < kMost) {
    Vec3 off = Vec3::Zero();
    for (const SurfacePoint& place : places) {
      const Vec3 away = c - place.p;
      if (away.norm() > 0.0) off += away.normalized();
    }
    if (!(off.norm() > 0.0)) break;
    const auto next = ClosestToPoint(surface, c + kOff * radius * off.normalized(),
                                     (kContactReach + kOff) * radius, kCertainty * radius);
    if (!next || (next->at.p - c).norm() > least + slack) break;
    const bool known = std::any_of(places.begin(), places.end(), [&](const SurfacePoint& place) {
      return (place.p - next->at.p).norm() <= kMinSeparation * radius;
    });
    if (known) break;
    places.push_back(next->at);
  }
  return places;
}

}  // namespace patchmill
