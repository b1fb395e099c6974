// A box as a CAD file gives it: six faces of several patches each.
#pragma once

#include "tests/support/shapes.h"

namespace patchmill::testing {

// Closed box [0,size]^3. Each face has cuts x cuts patches. "f1" is the bottom, "f2" the top, the others are
// the sides x = 0, x = size, y = 0, y = size; u x v points out. Sides are called "wall" and are red.
inline PatchModel FacedBox(double size, int cuts) {
  PatchModel model;
  const auto add = [&](const Vec3& origin, const Vec3& u, const Vec3& v, const std::string& name) {
    ModelFace face;
    face.id = "f" + std::to_string(model.faces.size() + 1);
    face.name = name;
    face.kind = SurfaceKind::kPlane;
    face.body = "BOX";
    if (name == "wall") face.rgb = 0xFF0000;
    const FaceId id(model.faces.size());
    model.faces.push_back(face);
    const auto at = [&](int i, int j) { return Vec3(origin + u * i / cuts + v * j / cuts); };
    for (int i = 0; i < cuts; ++i) {
      for (int j = 0; j < cuts; ++j) {
        const int number = i * cuts + j + 1;
        model.patches.push_back({face.id + "." + std::to_string(number),
                                 Bilinear(at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)), id});
      }
    }
  };
  const Vec3 x(size, 0, 0), y(0, size, 0), z(0, 0, size), o = Vec3::Zero();
  add(o, y, x, "");
  add(z, x, y, "lid");
  add(o, z, y, "wall");
  add(x, y, z, "wall");
  add(o, x, z, "wall");
  add(y, z, x, "wall");
  return model;
}

}  // namespace patchmill::testing
