#include "cam/path/zlevel/direction_cone.h"

#include <cmath>

namespace patchmill {

double DirectionCone::Angle() const { return std::atan2(Cross(right, left), right.dot(left)); }

void DirectionCone::Add(const Vec2& e) {
  if (!valid) return;
  if (empty) {
    right = left = e;
    empty = false;
    return;
  }
  const double from_right = Cross(right, e), from_left = Cross(left, e);
  if (from_right >= 0.0 && from_left <= 0.0) {
    valid = right.dot(e) > 0.0 || left.dot(e) > 0.0 || from_right > 0.0;
  } else if (from_right > 0.0) {
    left = e;
  } else if (from_left < 0.0) {
    right = e;
  } else {
    valid = false;
  }
}

void DirectionCone::Add(const DirectionCone& other) {
  if (!other.valid) {
    valid = empty = false;
  } else if (!other.empty) {
    Add(other.right);
    Add(other.left);
  }
}

}  // namespace patchmill
