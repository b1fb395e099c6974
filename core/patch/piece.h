// One algebra for all patches [shapes, section 8]: every patch is cut into pieces, and each piece is a
// rational Bernstein rectangle.
//
//   kind              pieces
//   Bezier            1 of its own degrees; more, in a grid, if weights are far apart (ConditionPieces)
//   B-spline          1 of its own degrees per non-empty knot rectangle, or more as above
//   Gregory quad      1, rational of degree 5 (edge blend) or 7 each way
//   triangle          of degree n: 3 of degree n each way around its centroid (a bilinear map of the
//                     rectangle into the triangle; no collapsed edge)
//   Brown quad        1 per rectangle between breaks, rational of 4 degrees more
//   Gregory triangle  3, as a rational triangle of degree 6 (edge blend) or 7
//   loft triangle     3, as a rational triangle of degree 8, with squared weights 3 degree + 1
//   G2-Gregory        1, rational of 8 degrees more
//   Hosaka            1 per rectangle of the break parameters, polynomial
//
// Bulges cut a quad at their places. Its pieces have the degrees above, but no less than 5 more than their
// denominator has.
//
// Algorithms that plan, bound and measure see pieces only.
#pragma once

#include <array>
#include <vector>

#include "core/base/typed_id.h"
#include "core/patch/patch.h"

namespace patchmill {

// Homogeneous control points (w x, w y, w z, w) of a tensor Bernstein form; points[i * (degree_v + 1) + j], i
// along u. A polynomial net has all w = 1. A point with w = 0 has all coordinates 0 (singular Gregory corner,
// [location T10]) and does not belong to the hull: the surface lies in the convex hull of {xyz / w : w > 0}.
struct BernsteinNet {
  int degree_u = 0;
  int degree_v = 0;
  bool rational = false;
  std::vector<Vec4> points;
};

// The part [u0,u1] x [v0,v1] of the parameters of a patch or piece, all in [0, 1].
struct ParameterBox {
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 1.0;
};

// The part u in [u0,u1], v in [v0,v1] of a net, by de Casteljau on homogeneous points. Cost O(degree^3).
BernsteinNet SubNet(const BernsteinNet& net, double u0, double u1, double v0, double v1);

struct Piece {
  PatchId patch;
  BernsteinNet net;  // exact for every kind
  // Gregory pieces are evaluated natively (faster, and correct at the corners), others from the net.
  const GregoryPatch* gregory = nullptr;
  // The patch itself, if the net is singular at a corner and the kind has no member of its own. The piece is
  // then evaluated through `native`.
  const PatchShape* shape = nullptr;
  // Native parameters of the piece's corners (0,0) (1,0) (0,1) (1,1). The map between them is exactly
  // bilinear in Eased(u, speed.x()) and Eased(v, speed.y()).
  std::array<Vec2, 4> native;
  Vec2 speed = Vec2(1.0, 1.0);
  FaceSides sides;  // in the piece's own parameters
};

// A linear fractional map of [0, 1] onto itself. It begins at this speed (> 0) and ends at 1 / speed. The map
// of the inverse speed is its inverse.
inline double Eased(double t, double speed) { return speed * t / ((1.0 - t) + speed * t); }

// The pieces of a patch; never empty for a valid one. Pieces of a B-spline come in order of u span, then v
// span. They may point to `shape`, which must outlive them in its place.
std::vector<Piece> SplitIntoPieces(PatchId id, const PatchShape& shape);
std::vector<Piece> SplitIntoPieces(PatchId id, const PatchShape&& shape) = delete;

// Jet in the piece's own parameters (u,v) in [0,1]^2.
SurfaceJet Evaluate(const Piece& piece, double u, double v);
// As Evaluate and with the same bits, for callers that need no second derivatives: these may be zero. Takes
// fewer operations for polynomial bicubic pieces and the same for others.
SurfaceJet EvaluateSlopes(const Piece& piece, double u, double v);
Vec3 Position(const Piece& piece, double u, double v);
Vec2 NativeParameters(const Piece& piece, double u, double v);

}  // namespace patchmill
