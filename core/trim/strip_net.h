// The exact patch over a strip of a carrier's parameters: the surface composed with the map of the strip
// [trimming (3)].
#pragma once

#include "core/patch/piece.h"
#include "core/trim/grid_graph.h"

namespace patchmill {

// Between two graphs along the same axis over the same interval, in the carrier's own parameters [0,1]^2.
// All coefficients lie in [0,1], and those of `high` are not below those of `low`.
struct Strip {
  GridGraph low, high;
};

// The net with its parameters exchanged.
BernsteinNet Transposed(const BernsteinNet& net);

// Largest degree of a graph whose strip keeps both degrees at most kMaxDegree; 0 if there is none.
int LargestStripDegree(const BernsteinNet& carrier, bool along_u);

// S(u, (1-t) low(u) + t high(u)), with u = from + s (to - from), is a rational Bezier patch of the degrees
// (p + q d, q) in (s, t), where d is the degree of the graphs; likewise along v. It lies on the carrier
// exactly, to about 1e-15 of its size. Its u and v run as the carrier's. Both degrees must be at most
// kMaxDegree. Cost O((p + q d) q p q).
// New points are convex combinations of the old ones, so weights stay positive.
BernsteinNet StripNet(const BernsteinNet& carrier, const Strip& strip);

}  // namespace patchmill
