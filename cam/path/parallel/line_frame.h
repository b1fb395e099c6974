// The plan frame of a family of zig-zag lines: t along them, y across.
#pragma once

#include "core/base/vec.h"

namespace patchmill {

// The circles around a place in plan with radii from `inner` to `outer`, along which an area is cut.
struct CircularLines {
  Vec2 center = Vec2::Zero();
  double inner = 0.0, outer = 0.0;  // mm, 0 <= inner < outer

  bool operator==(const CircularLines&) const = default;
};

// Flat step-overs: largest distance between a circle and the chords along which it is cut.
inline constexpr double kCircleSagitta = 0.01;

// A line is given by y over t, both in mm. In a straight frame lines of constant y are parallel; t runs along
// them and y to their left. In a round frame (CircularLines) they are circles: y is the radius, and t is the
// angle, counter-clockwise from +x, times the fixed radius `at`; t repeats after period(). In either frame
// the distance in plan between two lines of constant y is the difference of their y.
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
  double at_ = 0.0;  // mm: radius at which t is measured; 0: straight frame
};

}  // namespace patchmill
