// Which parts of the surface no ball can finish: whole rectangles judged by nine places on them.
#pragma once

#include <array>
#include <optional>

#include "core/diffgeo/forms.h"
#include "core/surface/surface.h"

namespace patchmill {

// A part of a piece, u0 <= u1, v0 <= v1 in its own parameters.
struct SurfaceRect {
  PieceId piece;
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 1.0;
};

// Nine places on a rectangle (u, v): 0..3 the corners, 4..7 the middles of the sides, 8 the middle.
std::array<Vec2, 9> NineParameters(const SurfaceRect& rect);

// The surface there; normals are unit and all on one side of it.
struct RectPlaces {
  std::array<Vec3, 9> p, n;
  int air_side = 0;               // of upright places: 1 the side of n, -1 the other, 0 unknown (SurfaceJet)
  double upright = kUprightFace;  // SurfaceJet::upright
};
// nullopt where the normals turn by more than 0.7 rad, or have no direction.
std::optional<RectPlaces> PlacesOn(const Surface& surface, const SurfaceRect& rect);

// How far the values at the nine places are from a bilinear function, twice: what is to be added to its
// corners to bound a function of small third derivatives over the rectangle.
double BendOver(const std::array<Vec3, 9>& f);
// Too much of it for nine places to tell of the function: more than a quarter of how far its values lie
// apart, or of the rectangle's diameter.
bool TooBent(const std::array<Vec3, 9>& f, double size);

struct CellReachParams {
  double radius = 0.0;  // mm: centres lie at p + radius n
  double reach_tolerance =
      0.0;  // mm: how deep the surface may lie inside the ball, and centres below the floor
  double floor_z = -kInfinity;  // mm: lowest centre height
  // mm: where the deepest point is not in the way by more than it is known, it is known to this; 0: as it is.
  // For places that are known not to be free.
  double proof = 0.0;
  // mm: beside a silhouette, where a side that looks down turns up on no more than a strip this wide, that
  // strip is not counted.
  double narrow = 0.0;
};

// Surface points in the ball's way, for either side of the surface: what was found for a rectangle serves its
// parts.
using Blockers = std::array<std::optional<SurfacePoint>, 2>;

// Of either side of the surface: no ball there counts, as is known.
using SidesRuledOut = std::array<bool, 2>;

// True when no ball centred over the rectangle is free: on either side of the surface it looks down, all
// centres are below the floor, or one surface point lies deeper than `give` in all the balls (distance
// to the upward ray, so that the shank counts). The distance of a surface point to the upward ray is convex
// in the centre, hence largest at the corners of what the centres span; how far they leave it is taken from
// the nine places (second order, twice). `size`: diameter of the rectangle, mm. `blockers` are tried first
// and replaced by the deepest points.
bool OutOfReach(const Surface& surface, const RectPlaces& at, double size, const CellReachParams& params,
                Blockers& blockers, const SidesRuledOut& ruled_out = {});

}  // namespace patchmill
