// The proof of Locator::GougeWithin, leaf by leaf: finds the leaves of the surface that may be in the way of
// a straight move.
#pragma once

#include <cstdint>
#include <vector>

#include "cam/location/locator_impl.h"

namespace patchmill::internal {

// A straight move from a to b, and how far the surface must stay away from it.
struct SweptMove {
  const Vec3 &a, &b;
  double distance;  // mm, > 0
  double
      spare;  // mm: accuracy; intervals of the move are not halved once [location T2a] loses less than this
};

// Collects in `open` the leaves that are not proven to stay at least move.distance away from the move with
// everything above it. All other leaves are proven. Returns false if it meets a surface point nearer
// than that; `open` is then meaningless. Cost: one walk over the tree, and a few bounds at centres on
// the move for each leaf met.
//
// Proof for a leaf. At centres on the move its distance is bounded from below by its oriented box, by its
// second-order model (LeastOn), or from f and its slope near the minimum (LeastFrom; if f is convex on the
// leaf, also the tangent plane). Between two centres [location T2a] bounds it (ChordDistance2). Intervals are
// halved until that suffices, or until [location T2a] loses less than move.spare of the distance.
bool CollectSweptLeaves(const Locator::Impl& impl, const SweptMove& move, std::vector<std::int32_t>& open);

}  // namespace patchmill::internal
