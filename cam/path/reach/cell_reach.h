// Finds which parts of the surface no ball can finish. Whole rectangles are judged by nine places on them.
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
  double size = 0.0;              // mm, diameter of the rectangle
  int air_side = 0;               // at vertical places: 1 the side of n, -1 the other, 0 unknown (SurfaceJet)
  double upright = kUprightFace;  // SurfaceJet::upright
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
  double reach_tolerance =
      0.0;  // mm: how deep the surface may lie inside the ball, and centres below the floor
  double floor_z = -kInfinity;  // mm: lowest centre height
  // mm: if the deepest point is not known well enough to decide, it is located again to this accuracy; 0: it
  // is not. This is for places that are known not to be free.
  double proof = 0.0;
  // mm: at a silhouette, where a side that looks down turns up on no more than a strip this wide, the strip
  // does not count.
  double narrow = 0.0;
};

// Surface points in the ball's way, for either side of the surface. A rectangle's serve its parts too.
using Blockers = std::array<std::optional<SurfacePoint>, 2>;

// For either side of the surface: true if no ball there counts, as the caller knows.
using SidesRuledOut = std::array<bool, 2>;

// Returns true if no ball centred over the rectangle is free. On each side of the surface one of these holds:
// the side looks down, all centres are below the floor, or one surface point lies deeper than
// `params.reach_tolerance` in all the balls (by distance to the upward ray, so that the shank counts). The
// distance of a surface point to the upward ray is convex in the centre, hence largest at the corners of what
// the centres span. How far centres leave that span is estimated from the nine places (second order, twice).
// `blockers` are tried first and replaced by the deepest points.
bool OutOfReach(const Surface& surface, const RectPlaces& at, const CellReachParams& params,
                Blockers& blockers, const SidesRuledOut& ruled_out = {});

}  // namespace patchmill
