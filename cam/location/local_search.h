// Newton's method on one piece: raises the ball where the surface is in its way ([location, section 7]).
#pragma once

#include "cam/location/leaf_model.h"
#include "cam/location/ray_distance.h"

namespace patchmill::internal {

// The highest contact so far. `slope` is the derivative of -f with respect to the piece's (u, v) at the
// contact. It is zero in free directions and NaN if the search ended early. Its signs are the KKT conditions.
struct Contact {
  double z = -kInfinity;  // centre height
  int piece = -1;         // -1: no contact yet, z is only a lower bound
  double u = 0.0, v = 0.0;
  Vec3 p = Vec3::Zero();
  Vec2 slope = Vec2::Zero();
};

struct Ball {
  Vec2 q;
  double radius;
  double slack;  // mm; smaller differences mean nothing
  // A point with f = 1/2 dist^2 of at least this counts as outside.
  double FreeF() const { return radius * (0.5 * radius - slack); }
};

struct SearchOptions {
  double max_step = kInfinity;  // mm, longest step on the surface per iteration
  // The model of `rect` and its BoundBelow for the centre at the first best.z; set both or none. The search
  // gives up if they prove that the rectangle is outside.
  const LeafModel* model = nullptr;
  const LowerModel* lower = nullptr;
};

// How a search ended. If f is convex on `rect` (for the final best.z), it is nowhere below convex_minimum.
struct SearchResult {
  bool improved = false;
  bool out = false;  // f is proven to be nowhere below FreeF() on `rect`
  double convex_minimum = -kInfinity;
  double u = 0.0, v = 0.0;  // where the search ended, and f there
  Vec3 p = Vec3::Zero();
  double f = 0.0;
  Vec2 slope = Vec2::Zero();  // derivative of -f there; NaN if the search was cut short
};

// A part of a piece.
struct PiecePart {
  const Piece& piece;
  int index;  // of the piece
  Rect rect;
};

// Minimises f(u,v) = 1/2 dist^2(S, upward ray from (q, best.z)) on part.rect, starting at `start`.
// Whenever the surface comes closer than R, the ball is raised to touch it (best.z = g) and the search
// continues. It ends at a local maximum of g, or if nothing within reach lies in the way. It uses the
// exact Hessian, the exact quadratic step on the box and a line search. best.z must be finite. The g of a
// contact is exact to about 1e-12 mm.
SearchResult RaiseOnPiece(const PiecePart& part, const Vec2& start, const Ball& ball,
                          const SearchOptions& options, Contact& best);

// f at a place of `rect`, in local parameters. d is the vector from the place to the ray, `slope` is S_u.d,
// S_v.d.
LocalJet LocalJetAt(const Rect& rect, double u, double v, const Vec3& d, const Vec2& slope);

// The smallest value over `rect` of the linear minorant f + grad.(x - x0) of a convex f with -grad = slope.
double LinearMinimum(double f, const Vec2& slope, const Rect& rect, double u, double v);

}  // namespace patchmill::internal
