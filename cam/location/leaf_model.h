// A second-order model of a small parameter rectangle with proven bounds of what it leaves out: the convexity
// test of [location T6] in a few dozen operations, without evaluating the surface.
//
// With local parameters x, y in [-1/2, 1/2]:  S = s + a x + b y + uu x^2/2 + uv x y + vv y^2/2 + rest.
// For a centre c, f = 1/2 |S - c|^2 has the Hessian  S_i.S_j + (S - c).S_ij, which differs anywhere on the
// rectangle by at most  e_ij = gram_ij + (|s - c| + reach) drift_ij  from its middle value.
#pragma once

#include "cam/location/leaf_errors.h"
#include "core/base/round_outward.h"
#include "core/math/box_qp.h"
#include "core/surface/net_kernel.h"

namespace patchmill::internal {

struct Rect {
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 1.0;
};

struct LeafModel : LeafErrors {
  Vec3 s, a, b, uu, uv, vv;
};

// Model of the part `rect` of a piece; `points` is its net (already restricted), hull as from HullPoints,
// `middle` the piece's jet at the middle of `rect` in the piece's own parameters. Cost O(points).
LeafModel MakeLeafModel(NetShape shape, const Vec4* points, bool rational, const Vec3* hull, int hull_count,
                        const SurfaceJet& middle, const Rect& rect);
// The same; a Gregory quad's derivatives are bounded from its own form (gregory_bounds.h), not from the net.
LeafModel MakeLeafModel(const Piece& piece, const Vec4* points, const Vec3* hull, int hull_count,
                        const Rect& rect);

// A quadratic with value f0 at the middle whose Hessian is below that of f = 1/2 dist^2(S, upward ray from c)
// everywhere on the rectangle.
struct LowerModel {
  bool convex = false;    // the Hessian is positive definite: f is convex on the rectangle
  bool minorant = false;  // f0 + q(x, y) <= f on the whole rectangle (the rectangle does not rise above c)
  double f0 = 0.0;
  Quadratic2 q;  // local parameters
};
LowerModel BoundBelow(const LeafModel& model, const Vec3& c);

// Where the rectangle rises above c: for any depth t >= 0, f >= 1/2 |S_xy - c_xy|^2 + t (c_z - S_z) - t^2 /
// 2, a half-space's squared distance in height for the ray's; with equality where S lies t below c, or not
// below it and t = 0. Its own quadratic, always a minorant; `convex` says nothing.
LowerModel BoundBelowAtDepth(const LeafModel& model, const Vec3& c, double depth);

// A lower bound of f over the rectangle: the least of the minorant `low` = BoundBelow(model, c), or, where
// that is none, of the one at the depth where the model comes nearest.
double LeastOn(const LeafModel& model, const LowerModel& low, const Vec3& c);

// f and its gradient at a place (x, y) of the rectangle, all in local parameters; `depth` is how far S lies
// below c there, 0 where it does not.
struct LocalJet {
  double x = 0.0, y = 0.0;
  double f = 0.0;
  Vec2 gradient = Vec2::Zero();
  double depth = 0.0;
};
// A lower bound of f over the rectangle from its value at one place: f and the bound at that depth touch
// there, so the Taylor polynomial with the bound's least Hessian lies below both. Much tighter than LeastOn
// where the place is near the minimum. `low` as for LeastOn. Over `part` of the rectangle, in local
// parameters.
double LeastFrom(const LeafModel& model, const LowerModel& low, const Vec3& c, const LocalJet& at,
                 const Box2& part = {-0.5, 0.5, -0.5, 0.5});

// The middle model's own minimiser: where to start a search.
BoxMinimum GuessMinimum(const LeafModel& model, const Vec3& c);

}  // namespace patchmill::internal
