// Flat walls and floors, for tests of parts with upright walls.
#pragma once

#include "tests/support/shapes.h"

namespace patchmill::testing {

// A wall from a to b, from z0 up to z1; du runs along it, or up it when `turned`.
inline PatchModel Wall(const Vec2& a, const Vec2& b, double z0, double z1, bool turned = false) {
  const Vec3 al = Lift(a, z0), ah = Lift(a, z1), bl = Lift(b, z0), bh = Lift(b, z1);
  return Single(turned ? Bilinear(al, ah, bl, bh) : Bilinear(al, bl, ah, bh));
}

inline PatchModel Level(double x0, double y0, double x1, double y1, double z) {
  return Single(Bilinear({x0, y0, z}, {x1, y0, z}, {x0, y1, z}, {x1, y1, z}));
}

// Four walls around [-x,x] x [-y,y], every second one turned, up to z1.
inline PatchModel Walls(double x, double y, double z0, double z1) {
  return Join({Wall({-x, -y}, {x, -y}, z0, z1), Wall({x, -y}, {x, y}, z0, z1, true),
               Wall({x, y}, {-x, y}, z0, z1), Wall({-x, y}, {-x, -y}, z0, z1, true)});
}

// A floor at z = 0 with walls around it, open at the top.
inline PatchModel OpenBox(double x, double y, double z) {
  return Join({Level(-x, -y, x, y, 0), Walls(x, y, 0, z)});
}

// The open box with walls of degree 7 upwards. Their control points go in and out by `shift` (mm) by turns,
// and the walls wave by a third of that.
inline PatchModel WavingBox(double x, double y, double z, double shift) {
  PatchModel model = Level(-x, -y, x, y, 0);
  const Vec2 corners[] = {{-x, -y}, {x, -y}, {x, y}, {-x, y}, {-x, -y}};
  constexpr int kDegree = 7;
  for (int wall = 0; wall < 4; ++wall) {
    BezierPatch patch{1, kDegree, {}, {}};
    for (const Vec2& corner : {corners[wall], corners[wall + 1]}) {
      for (int j = 0; j <= kDegree; ++j) {
        const double out = j == 0 || j == kDegree ? 0.0 : j % 2 == 0 ? shift : -shift;
        patch.points.push_back(Lift(Vec2(corner.array() + out * corner.array().sign()), z * j / kDegree));
      }
    }
    model = Join({std::move(model), Single(std::move(patch))});
  }
  return model;
}

// Closed all around.
inline PatchModel ClosedBlock(double x, double y, double z) {
  return Join({Level(-x, -y, x, y, z), Level(-x, -y, x, y, 0), Walls(x, y, 0, z)});
}

}  // namespace patchmill::testing
