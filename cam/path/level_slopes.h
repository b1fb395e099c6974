// Which slopes a piece of surface can have: bounds on its normals from its Bernstein net.
#pragma once

#include <vector>

#include "core/patch/piece.h"

namespace patchmill {

// Angles of the (unoriented) normal from vertical, rad in [0, pi/2].
struct SlopeRange {
  double min = 0.0;
  double max = kPi / 2.0;
};

// Holds every normal of the net's surface; the full range where nothing tighter is proven (degenerate
// parametrisation, strongly bent nets). Directions of S_u and S_v lie in the cones of their control vectors
// (for rational nets those of N_u w - N w_u), the cross product's cone follows (Sederberg and Meyers 1988).
// Cost O(points) for polynomial nets, O(points^2) for rational ones.
SlopeRange BoundSlopes(const BernsteinNet& net);

}  // namespace patchmill
