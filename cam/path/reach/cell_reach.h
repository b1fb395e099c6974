// Finds rectangles of the surface that this ball can finish nowhere. A rectangle is judged by nine places on
// it.
#pragma once

#include <array>
#include <optional>

#include "core/diffgeo/forms.h"
#include "core/surface/surface.h"

namespace patchmill {

// A part of a piece: u0 <= u1, v0 <= v1 in the piece's own parameters.
struct SurfaceRect {
  PieceId piece;
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 1.0;
};

// Returns nine places (u, v) on a rectangle: 0..3 the corners, 4..7 the middles of the sides, 8 the middle.
std::array<Vec2, 9> NineParameters(const SurfaceRect& rect);

// The surface at the nine places. Normals are unit vectors, all on one side of the surface.
struct RectPlaces {
  std::array<Vec3, 9> p, n;
  double size = 0.0;  // mm, diameter of the rectangle
  FaceSides sides;    // of the face; `air_side` 1 is the side of n
};
// `size` is that of the rectangle, or an upper bound. Returns nullopt where the normals turn by more than 0.7
// rad, or have no direction.
std::optional<RectPlaces> PlacesOn(const Surface& surface, const SurfaceRect& rect, double size);

// Returns twice the largest distance of the values at the nine places from a bilinear function. Added to the
// values at the corners it bounds a function of small third derivatives over the rectangle.
double BendOver(const std::array<Vec3, 9>& f);
// True if the function bends too much for nine places: by more than a quarter of the largest distance of its
// values, or of `size`, the diameter of the rectangle.
bool TooBent(const std::array<Vec3, 9>& f, double size);

struct CellReachParams {
  double radius = 0.0;  // mm: centres lie at p + radius n
  // mm: so deep may the surface lie inside a ball that counts as free, and the floor above the lowest centre.
  double reach_tolerance = 0.0;
  double floor_z = -kInfinity;  // mm: lowest centre height
  // mm: if the point that is deepest in the balls is not known exactly enough to decide, it is located once
  // more to this accuracy. 0: it is not. Use it if the balls are known not to be free.
  double proof = 0.0;
  // mm, for rectangles on a silhouette: if one side of the surface looks up only on a strip that is no wider
  // than this, the side counts as one that looks down.
  double narrow = 0.0;
};

// For each side of the surface: a surface point that is in the way of all balls over a rectangle, if one is
// known. It is in the way over all parts of the rectangle, too.
using Blockers = std::array<std::optional<SurfacePoint>, 2>;

// For each side of the surface: true if the caller knows that balls on it need not be examined.
using SidesRuledOut = std::array<bool, 2>;

// Returns true if no ball that touches the rectangle is free. On each side of the surface one of three
// conditions must hold: the side looks down; all centres are below the floor; one surface point is deeper
// than `params.reach_tolerance` in every ball or its upward sweep. The third is decided by [regions T15]: the
// distance of a surface point from the upward ray is convex in the centre, so over the hull of the four
// corners' centres it is largest at a corner. How far the other centres leave this hull is estimated from the
// nine places, as twice the second-order term (BendOver). `blockers` are tried first, and are replaced by the
// points found.
bool OutOfReach(const Surface& surface, const RectPlaces& at, const CellReachParams& params,
                Blockers& blockers, const SidesRuledOut& ruled_out = {});

}  // namespace patchmill
