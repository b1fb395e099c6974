// The direction across the feed. Neighbouring passes lie side by side in it.
#pragma once

#include <cmath>
#include <optional>

#include "core/base/vec.h"

namespace patchmill {

// Returns the unit tangent across the feed at a surface point of unit normal `e`, e_z >= 0. Returns nothing
// where the feed has no direction: for contours on a horizontal surface, and for lines along the normal of a
// vertical wall.
inline std::optional<Vec3> AcrossFeed(const Vec3& e, const Vec3& feed) {
  const double length = feed.norm();
  if (!(length > 1e-9)) return std::nullopt;
  return Vec3(e.cross(feed / length));
}
// Passes at constant z: the direction is straight up or down the slope.
inline std::optional<Vec3> AcrossContours(const Vec3& e) { return AcrossFeed(e, Vec3(e.y(), -e.x(), 0.0)); }
// Lines that run in plan along `line`, a unit vector, or along `angle` (rad from the x axis).
inline std::optional<Vec3> AcrossLines(const Vec3& e, const Vec2& line) {
  return AcrossFeed(e, Lift(line * e.z(), -line.dot(Xy(e))));
}
inline std::optional<Vec3> AcrossLines(const Vec3& e, double angle) {
  return AcrossLines(e, Vec2(std::cos(angle), std::sin(angle)));
}

}  // namespace patchmill
