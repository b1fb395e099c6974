#include "cam/path/edge/border_places.h"

#include <algorithm>

namespace patchmill {
namespace {

void Thin(const std::vector<Vec2>& places, std::size_t first, std::size_t last, double tolerance,
          std::vector<Vec2>& out) {
  const Vec2 way = places[last] - places[first];
  double farthest = tolerance;
  std::size_t at = first;
  for (std::size_t i = first + 1; i < last; ++i) {
    const Vec2 from = places[i] - places[first];
    const double t = way.squaredNorm() > 0.0 ? std::clamp(from.dot(way) / way.squaredNorm(), 0.0, 1.0) : 0.0;
    const double distance = (from - t * way).norm();
    if (distance > farthest) {
      farthest = distance;
      at = i;
    }
  }
  if (at == first) {
    out.push_back(places[last]);
    return;
  }
  Thin(places, first, at, tolerance, out);
  Thin(places, at, last, tolerance, out);
}

}  // namespace

std::vector<Vec3> PlacesOn(const BorderCurve& border, double spacing) {
  std::vector<Vec3> points = border.points;
  if (border.closed && !points.empty()) points.push_back(points.front());
  std::vector<Vec3> places;
  double left = 0.0;  // from points[i - 1] to the next place
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec3 way = points[i] - points[i - 1];
    const double length = way.norm();
    for (; left < length; left += spacing) places.push_back(points[i - 1] + left / length * way);
    left -= length;
  }
  if (!points.empty()) places.push_back(points.back());
  return places;
}

std::vector<Vec2> Thinned(const std::vector<Vec2>& places, double tolerance) {
  std::vector<Vec2> thinned = {places.front()};
  Thin(places, 0, places.size() - 1, tolerance, thinned);
  return thinned;
}

}  // namespace patchmill
