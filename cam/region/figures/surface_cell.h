// A piece of ground that is bounded from its far side: by points that all of it lies between.
#pragma once

#include <array>
#include <optional>

#include "core/diffgeo/forms.h"
#include "core/surface/surface.h"

namespace patchmill {

// A triangle of parameters with straight sides, or one point.
struct SurfaceElement {
  bool point = false;
  std::size_t piece = 0;
  std::array<Vec2, 3> uv{};
  // Corners and Bezier points of the quadratic that has them and the middles of the sides: the surface
  // is taken for it, wrong by the third power of its size. All the same where it is a point.
  std::array<Vec3, 6> hull{};
  std::optional<Facing> facing;  // of a point; none where the surface has no normal
};

// A place of a cell: its middle.
struct ElementPlace {
  Vec3 p = Vec3::Zero();
  std::optional<Facing> facing;  // none where the surface has no normal
};

SurfaceElement PointElement(const Vec3& p, const std::optional<Facing>& facing);
SurfaceElement TriangleElement(const Surface& surface, std::size_t piece, const std::array<Vec2, 3>& uv);
ElementPlace MiddleOf(const Surface& surface, const SurfaceElement& cell);
// Of a triangle.
std::array<SurfaceElement, 4> Quarters(const Surface& surface, const SurfaceElement& cell);

// Nothing of the cell is farther from `from` (mm); `known` where that is no less.
double Farthest(const SurfaceElement& cell, const Vec3& from, double known = kInfinity);

}  // namespace patchmill
