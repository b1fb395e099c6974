// The surface of a face as a grid of rational Bezier patches, its carriers, and the point of it closest to a
// place.
//
// Grid coordinates: (U, V) in [0, count_u] x [0, count_v]. The carrier (i, j) covers [i, i+1] x [j, j+1] with
// its own parameters (U - i, V - j). Surfaces of revolution have one carrier for each quarter turn, which
// begins at a multiple of 90 degrees; splines have one for each rectangle between knots
// [trimming, section 2].
#pragma once

#include <optional>
#include <vector>

#include "core/base/vec.h"
#include "core/brep/brep_model.h"
#include "core/patch/piece.h"

namespace patchmill {

// One direction of the grid.
struct GridAxis {
  std::vector<double> breaks;  // the file's parameters at the grid lines; increasing
  bool angle = false;          // they are angles, multiples of a quarter turn
  int count() const { return static_cast<int>(breaks.size()) - 1; }
};

struct CarrierGrid {
  GridAxis u, v;
  std::vector<Piece> carriers;  // [i * v.count() + j]
  double size = 0.0;            // mm, of the box of all control points

  const Piece& carrier(int i, int j) const { return carriers[static_cast<std::size_t>(i * v.count() + j)]; }
};

// The grid that covers the file's parameters between two corners. Exact: quarter turns are
// rational quadratics with the weights 1, cos 45 degrees, 1. Planes are bilinear. A cone ends at its apex.
CarrierGrid CarriersOf(const BrepSurface& surface, const Vec2& lowest, const Vec2& highest);

// Grid coordinates of the file's parameters, about: in quarter turns to 1e-12, in knot spans exact.
Vec2 GridCoordinates(const CarrierGrid& grid, const Vec2& parameters);

// A carrier by its place in the grid.
struct GridCell {
  int i = 0, j = 0;
};
// The carrier that has the place; on a grid line the one with the higher number.
GridCell CellAt(const CarrierGrid& grid, const Vec2& at);
// Position and derivatives with respect to grid coordinates. Beyond the given carrier it is extrapolated.
SurfaceJet JetAt(const CarrierGrid& grid, GridCell cell, const Vec2& at);
Vec3 PositionAt(const CarrierGrid& grid, const Vec2& at);

struct GridFoot {
  Vec2 at = Vec2::Zero();  // grid coordinates
  Vec3 point = Vec3::Zero();
  double distance = 0.0;  // mm, from the place
};
// The closest point near `start` (grid coordinates), by Newton's method. Absent where that does not converge.
// It stays within the grid. At a pole the coordinate that does not matter there stays that of `start`.
std::optional<GridFoot> FootOnGrid(const CarrierGrid& grid, const Vec3& place, const Vec2& start);

}  // namespace patchmill
