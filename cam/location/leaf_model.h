// A second-order model of a small parameter rectangle with proven bounds of what it leaves out: the convexity
// test of ALGORITHMS T6 in a few dozen operations, without evaluating the surface.
//
// With local parameters x, y in [-1/2, 1/2]:  S = s + a x + b y + uu x^2/2 + uv x y + vv y^2/2 + rest.
// For a centre c, f = 1/2 |S - c|^2 has the Hessian  S_i.S_j + (S - c).S_ij, which differs anywhere on the
// rectangle by at most  e_ij = gram_ij + (|s - c| + reach) drift_ij  from its middle value.
#pragma once

#include <cmath>

#include "cam/location/leaf_errors.h"
#include "core/math/box_qp.h"
#include "core/surface/net_kernel.h"

namespace patchmill::internal {

struct Rect {
  double u0 = 0.0, u1 = 1.0, v0 = 0.0, v1 = 1.0;
};

struct LeafModel : LeafErrors {
  Vec3 s, a, b, uu, uv, vv;
};

// To floats without falling below, resp. rising above.
inline float RoundUp(double x) { return std::nextafterf(static_cast<float>(x), HUGE_VALF); }
inline float RoundDown(double x) { return std::nextafterf(static_cast<float>(x), -HUGE_VALF); }

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

// The middle model's own minimiser: where to start a search.
BoxMinimum GuessMinimum(const LeafModel& model, const Vec3& c);

}  // namespace patchmill::internal
