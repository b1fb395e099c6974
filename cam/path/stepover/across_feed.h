// The direction across the feed, in which neighbouring passes lie beside each other.
#pragma once

#include <cmath>
#include <optional>

#include "core/base/vec.h"

namespace patchmill {

// Unit tangents across the feed at a surface point of unit normal `e`, e_z >= 0. Nothing where the feed has
// no direction: contours on level ground, lines along an upright wall's normal.
inline std::optional<Vec3> AcrossFeed(const Vec3& e, const Vec3& feed) {
  const double length = feed.norm();
  if (!(length > 1e-9)) return std::nullopt;
  return Vec3(e.cross(feed / length));
}
// Passes at constant z: straight up or down the slope.
inline std::optional<Vec3> AcrossContours(const Vec3& e) { return AcrossFeed(e, Vec3(e.y(), -e.x(), 0.0)); }
// Lines whose plan runs along `line`, a unit vector, or along `angle` (rad from the x axis).
inline std::optional<Vec3> AcrossLines(const Vec3& e, const Vec2& line) {
  return AcrossFeed(e, Lift(line * e.z(), -line.dot(Xy(e))));
}
inline std::optional<Vec3> AcrossLines(const Vec3& e, double angle) {
  return AcrossLines(e, Vec2(std::cos(angle), std::sin(angle)));
}

}  // namespace patchmill
