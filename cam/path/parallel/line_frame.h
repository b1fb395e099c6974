// The plan frame of a family of zig-zag lines: t along them, y across.
#pragma once

#include "core/base/vec.h"

namespace patchmill {

// Circular lines: circles around a place in plan, where something is wanted between two distances from it.
struct CircularLines {
  Vec2 center = Vec2::Zero();
  double inner = 0.0, outer = 0.0;  // mm, 0 <= inner < outer

  bool operator==(const CircularLines&) const = default;
};

// Flat step-overs: largest distance between a circle and the chords along which it is cut.
inline constexpr double kCircleSagitta = 0.01;

// Straight: lines are parallel, and y is to their left. Round: y is the distance from a place, and t the way
// around it, counter-clockwise from +x, in mm at the distance `at`; both repeat after period(). In either
// case two lines of constant y are as far apart in plan as their y.
class LineFrame {
 public:
  static LineFrame At(double angle);
  static LineFrame Around(const Vec2& center, double at);

  bool round() const { return at_ > 0.0; }
  double period() const { return round() ? 2.0 * kPi * at_ : kInfinity; }  // of t

  Vec2 At(double t, double y) const;
  // Unit vectors in plan along which t and y rise.
  Vec2 Along(double t) const;
  Vec2 Across(double t) const;
  // mm in plan per mm of t.
  double Stretch(double y) const { return round() ? y / at_ : 1.0; }

 private:
  Vec2 along_ = Vec2::UnitX(), center_ = Vec2::Zero();
  double at_ = 0.0;  // mm; 0: straight
};

}  // namespace patchmill
