// A parallel view of the part. It maps points (mm) to the picture (px, y down) and to their nearness to the
// eye.
#pragma once

#include "core/base/vec.h"

namespace patchmill {

struct View {
  Vec3 right = Vec3::UnitX();   // unit, picture x
  Vec3 up = Vec3::UnitY();      // unit, picture up
  Vec3 toward = Vec3::UnitZ();  // unit, towards the eye
  double scale = 1.0;           // px per mm
  Vec2 origin = Vec2::Zero();   // px, place of the model point 0 0 0

  Vec2 operator()(const Vec3& p) const {
    return {origin.x() + scale * right.dot(p), origin.y() - scale * up.dot(p)};
  }
  double Nearness(const Vec3& p) const { return toward.dot(p); }
};

// From above; x to the right, y up.
inline View TopView() { return {}; }
// Isometric from the front right: x to the lower right, y to the upper right, z up.
inline View IsometricView() {
  View v;
  v.right = Vec3(1, 1, 0).normalized();
  v.toward = Vec3(1, -1, 1).normalized();
  v.up = v.toward.cross(v.right);
  return v;
}

// Scales and shifts the view so that the box fits into `width` x `height` px from `corner` (upper left).
View FitView(View view, const Box3& box, const Vec2& corner, double width, double height);

}  // namespace patchmill
