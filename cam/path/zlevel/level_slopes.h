// Bounds of the normals and slopes of a piece of surface, from its Bernstein net.
#pragma once

#include <vector>

#include "core/patch/piece.h"

namespace patchmill {

// Angles of the (unoriented) normal from vertical, rad in [0, pi/2].
struct SlopeRange {
  double min = 0.0;
  double max = kPi / 2.0;
};

// A cone that holds every unit normal of a part, up to one sign that they share.
struct NormalCone {
  Vec3 axis = Vec3::UnitZ();
  double angle = kPi;  // rad; kPi: nothing is proven
};

// Returns a cone that holds every normal of the net's surface. Where nothing is proven (degenerate
// parametrisation, strongly bent nets) it holds all directions. Directions of S_u and S_v lie in the cones of
// their control vectors (for rational nets those of N_u w - N w_u); the cone of the cross product follows
// [references: sederberg1988]. Cost O(points) for polynomial nets, O(points^2) for rational ones.
NormalCone BoundNormals(const BernsteinNet& net);

// Range of the slopes of a cone's normals.
SlopeRange SlopesOf(const NormalCone& normals);

inline SlopeRange BoundSlopes(const BernsteinNet& net) { return SlopesOf(BoundNormals(net)); }

}  // namespace patchmill
