// A small part of the surface with a hull of points, which bounds its largest distance from any place.
#pragma once

#include <array>
#include <optional>

#include "core/diffgeo/forms.h"
#include "core/surface/surface.h"

namespace patchmill {

// A triangle with straight sides in the parameters of a piece, or one point.
struct SurfaceElement {
  bool point = false;
  std::size_t piece = 0;
  std::array<Vec2, 3> uv{};
  // Corners and Bezier points of the quadratic surface through the corners and the middles of the sides. The
  // surface is taken for this quadratic; the error is of third order in the size of the triangle. For a point
  // all six are that point.
  std::array<Vec3, 6> hull{};
  std::optional<Facing> facing;  // set for a point; nullopt where the surface has no normal
};

// The middle of an element.
struct ElementPlace {
  Vec3 p = Vec3::Zero();
  std::optional<Facing> facing;  // nullopt where the surface has no normal
};

SurfaceElement PointElement(const Vec3& p, const std::optional<Facing>& facing);
SurfaceElement TriangleElement(const Surface& surface, std::size_t piece, const std::array<Vec2, 3>& uv);
ElementPlace MiddleOf(const Surface& surface, const SurfaceElement& cell);
// The four quarters of a triangle. The element must not be a point.
std::array<SurfaceElement, 4> Quarters(const Surface& surface, const SurfaceElement& cell);

// A distance (mm) from `from` that no point of the element exceeds. Returns `known` if the hull gives no
// smaller one.
double Farthest(const SurfaceElement& cell, const Vec3& from, double known = kInfinity);

}  // namespace patchmill
