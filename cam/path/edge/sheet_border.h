// Where a ball may go at the open edges of a sheet ([machining M12]).
#pragma once

#include <array>
#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

// Knows which sides of the pieces are open edges of the network (no neighbour, not collapsed, not a
// T-junction). Immutable; keeps a reference to the surface. Cost of the constructor O(pieces), of a query
// O(log open vertices).
class SheetBorder {
 public:
  // With `roll` the ball may roll over every open edge, as far as it touches it.
  explicit SheetBorder(const Surface& surface, bool roll = false);

  // True where the ball that touches `contact` in the direction `normal` ((centre - contact)/R) belongs to a
  // pass: inside the sheet, over creases, and at an open edge up to the surface normal. An open edge from
  // which the surface descends is a rim. There the ball may roll on until it stands right above the rim, on
  // both sides of a wall.
  bool Allowed(const SurfacePoint& contact, const Vec3& normal) const;

  // True at an open edge, its vertices included.
  bool On(const SurfacePoint& contact) const;

  // True where the direction is that of the surface itself, not that of a ball that rolls over an edge or a
  // crease. Tolerance 1e-5 rad.
  bool OnSurfaceNormal(const SurfacePoint& contact, const Vec3& normal) const;

 private:
  bool AtOpenVertex(const Vec3& p) const;
  struct Sides {
    bool open = false, fan_corner = false;
  };
  Sides SidesAt(const SurfacePoint& contact) const;

  const Surface& surface_;
  const bool roll_;
  // [piece][side]; sides 0: v=0, 1: u=1, 2: v=1, 3: u=0.
  std::vector<std::array<bool, 4>> open_;
  std::vector<Vec3> open_vertices_;  // ends of open edges, by x
  double same_point_ = 0.0;
};

// Returns the unit normal of the surface at the point, with z >= 0. At a degenerate corner it is that of a
// point just inside.
Vec3 UpwardNormalNear(const Surface& surface, const SurfacePoint& at);

}  // namespace patchmill
