// Which leaves may lie in the way of a straight move: the proof of GougeWithin, leaf by leaf.
#pragma once

#include <cstdint>
#include <vector>

#include "cam/location/locator_impl.h"

namespace patchmill::internal {

// Collects in `open` the leaves that are not proven to stay at least `distance` (mm, > 0) away from the move
// a b with everything above it; all others are. False, and `open` of no use, when a surface point nearer than
// that is met on the way. Cost: one walk over the tree, and per leaf met a few bounds at centres on the move.
//
// Proof for a leaf: at centres on the move its distance is bounded from below by its oriented box, by its
// second-order model (LeastOn), or from f and its slope near the minimum (LeastFrom, and where f is convex on
// it, the tangent plane); between two centres by [location T2a] (ChordDistance2). Intervals are halved until
// that suffices, and no further than where it takes `spare` (mm) of the distance.
bool CollectSweptLeaves(const Locator::Impl& impl, const Vec3& a, const Vec3& b, double distance,
                        double spare, std::vector<std::int32_t>& open);

}  // namespace patchmill::internal
