// Directions in the plane that lie within half a turn of each other.
#pragma once

#include "core/base/vec.h"

namespace patchmill {

// An open cone of directions in plan, narrower than pi, as its two extreme directions, of any length.
struct DirectionCone {
  bool valid = false;  // false: half a turn or more
  bool empty = true;
  Vec2 right = Vec2::Zero(), left = Vec2::Zero();  // counter-clockwise from right to left
  double Angle() const;                            // rad
  void Add(const Vec2& direction);
  void Add(const DirectionCone& other);
};

}  // namespace patchmill
