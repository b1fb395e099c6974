// Parts whose surfaces are legal and awkward: parametrisations that stand still on a line, and weights far
// apart. Sizes are in mm.
#pragma once

#include <array>
#include <cmath>

#include "core/network/patch_network.h"
#include "core/patch/patch.h"
#include "tests/support/shapes.h"

namespace patchmill::testing {

// A bicubic patch that is straight along v, from y = 0 to y = length. Its sections are the cubic with these
// points (x, z).
inline PatchModel CubicRuled(const std::array<Vec2, 4>& section, double length) {
  BezierPatch patch{3, 3, {}, {}};
  for (const Vec2& p : section) {
    for (int j = 0; j <= 3; ++j) patch.points.emplace_back(p.x(), length * j / 3.0, p.y());
  }
  return Single(patch);
}

// The plane z = 0 with x = 30 t^3 for t = 2 u - 1: S_u vanishes on the line x = 0.
inline PatchModel CubedPlane(double scale = 1.0) {
  return CubicRuled({Vec2(-30 * scale, 0), Vec2(30 * scale, 0), Vec2(-30 * scale, 0), Vec2(30 * scale, 0)},
                    60.0 * scale);
}

// A ridge with a cusp: x = 30 t^3, z = 20 - 20 t^2 for t = 2 u - 1, so z = 20 - 20 (|x| / 30)^(2/3).
inline PatchModel CuspedRidge(double scale = 1.0) {
  const double top = 80.0 / 3.0 * scale;
  return CubicRuled(
      {Vec2(-30 * scale, 0), Vec2(30 * scale, top), Vec2(-30 * scale, top), Vec2(30 * scale, 0)},
      60.0 * scale);
}

// An eighth of a sphere of radius 30, exactly, with weights from 1/ratio to ratio at its corners.
inline PatchModel WeightedOctant(double ratio) {
  const double h = std::sqrt(0.5), r = 30.0;
  const std::array<Vec3, 9> points = {Vec3(r, 0, 0), Vec3(r, 0, r), Vec3(0, 0, r),
                                      Vec3(r, r, 0), Vec3(r, r, r), Vec3(0, 0, r),
                                      Vec3(0, r, 0), Vec3(0, r, r), Vec3(0, 0, r)};
  BezierPatch patch{2, 2, {points.begin(), points.end()}, {}};
  // Weights a^i b^j more than those of the even one re-parametrise the same sphere.
  const double step = std::sqrt(ratio);
  for (int i = 0; i <= 2; ++i) {
    for (int j = 0; j <= 2; ++j) {
      const double even = (i == 1 ? h : 1.0) * (j == 1 ? h : 1.0);
      patch.weights.push_back(even * std::pow(step, i + j - 2));
    }
  }
  return Single(patch);
}

}  // namespace patchmill::testing
