// Decides where a pass may touch the open edges of a sheet ([machining M12]).
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

  // True if a ball that touches the surface at `contact` may belong to a pass. `normal` is (centre -
  // contact)/R. It may inside of a face and on a crease. On an open edge it may if `normal` is the normal of
  // the surface there. An open edge from which the surface descends inward is a rim; over a rim the ball may
  // also roll on until its centre is right above the rim.
  bool Allowed(const SurfacePoint& contact, const Vec3& normal) const;

  // True at an open edge, its vertices included.
  bool On(const SurfacePoint& contact) const;

  // True if `normal` is the normal of the surface at the contact, to 1e-5 rad. False where the ball rolls
  // over an edge or a crease.
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
  std::vector<Vec3> open_vertices_;  // ends of open edges, sorted by x
  double same_point_ = 0.0;          // mm: points this near to each other are one
};

// Returns the unit normal of the surface at the point, with z >= 0. At a degenerate corner it is that of a
// point just inside.
Vec3 UpwardNormalNear(const Surface& surface, const SurfacePoint& at);

}  // namespace patchmill
