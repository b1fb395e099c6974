// A second-order model of a small parameter rectangle with proven bounds of what it leaves out. It gives the
// convexity test of [location T6] in a few dozen operations, without an evaluation of the surface.
//
// With local parameters x, y in [-1/2, 1/2]:
//   S = s + a x + b y + uu x^2/2 + uv x y + vv y^2/2 + rest.
// For a centre c, f = 1/2 |S - c|^2 has the Hessian S_i.S_j + (S - c).S_ij. Anywhere on the rectangle it
// differs from its middle value by at most e_ij = gram_ij + (|s - c| + reach) drift_ij.
#pragma once

#include <optional>
#include <span>

#include "cam/location/leaf_errors.h"
#include "core/base/round_outward.h"
#include "core/math/box_qp.h"
#include "core/surface/net_kernel.h"

namespace patchmill::internal {

using Rect = ParameterBox;

struct LeafModel : LeafErrors {
  Vec3 s, a, b, uu, uv, vv;
  // For a rectangle that is steep along one parameter: the errors of its projection into the plan. Those
  // above know the plan only as a part of space, and a wall is thin there.
  std::optional<LeafErrors> plan = std::nullopt;
};

// The net of a part of a piece, already restricted to the part, and its points as from HullPoints. It refers
// to both.
struct PartNet {
  NetShape shape;
  const Vec4* points;
  bool rational;
  std::span<const Vec3> hull;
};

// Makes the model of the part `rect` of a piece. `middle` is the piece's jet at the middle of `rect`, in the
// piece's own parameters. Cost O(points).
LeafModel MakeLeafModel(const PartNet& net, const SurfaceJet& middle, const Rect& rect);
// The same. The derivatives of a Gregory quad are bounded from its own form (gregory_bounds.h), not from the
// net.
LeafModel MakeLeafModel(const Piece& piece, const Vec4* points, std::span<const Vec3> hull, const Rect& rect);

// A quadratic with value f0 at the middle. Everywhere on the rectangle its Hessian is below that of
// f = 1/2 dist^2(S, upward ray from c).
struct LowerModel {
  bool convex = false;    // the Hessian is positive definite: f is convex on the rectangle
  bool minorant = false;  // f0 + q(x, y) <= f on the whole rectangle (the rectangle does not rise above c)
  double f0 = 0.0;
  Quadratic2 q;  // in local parameters
};
LowerModel BoundBelow(const LeafModel& model, const Vec3& c);

// For a rectangle that rises above c. For any depth t >= 0,
// f >= 1/2 |S_xy - c_xy|^2 + t (c_z - S_z) - t^2 / 2.
// So a half-space's squared distance in height replaces the ray's. They are equal where S lies t below c, or
// is not below c and t = 0. The quadratic is always a minorant; `convex` means nothing.
LowerModel BoundBelowAtDepth(const LeafModel& model, const Vec3& c, double depth);

// A lower bound of f over the rectangle: the minimum of `low` = BoundBelow(model, c) if it is a minorant.
// Otherwise the minimum of BoundBelowAtDepth at the depth at which the model comes nearest.
double LeastOn(const LeafModel& model, const LowerModel& low, const Vec3& c);

// f and its gradient at a place (x, y) of the rectangle, in local parameters. `depth` is how far S lies below
// c there, or 0 if it does not.
struct LocalJet {
  double x = 0.0, y = 0.0;
  double f = 0.0;
  Vec2 gradient = Vec2::Zero();
  double depth = 0.0;
};
// A lower bound of f over the rectangle from its value at one place. f and the bound at that depth touch
// there. So the Taylor polynomial with the bound's smallest Hessian lies below both. If the place is near the
// minimum, this is much tighter than LeastOn. `low` is as for LeastOn. `part` is the part of the rectangle,
// in local parameters.
double LeastFrom(const LeafModel& model, const LowerModel& low, const Vec3& c, const LocalJet& at,
                 const Box2& part = {-0.5, 0.5, -0.5, 0.5});

// True if the rectangle is to be halved along u, not along v: it is longer that way.
bool IsLongerAlongU(const LeafModel& model);

// The minimiser of the middle model, as a start for a search.
BoxMinimum GuessMinimum(const LeafModel& model, const Vec3& c);

}  // namespace patchmill::internal
