// Finds the leaves that may lie in the way of a straight move: the proof of GougeWithin, leaf by leaf.
#pragma once

#include <cstdint>
#include <vector>

#include "cam/location/locator_impl.h"

namespace patchmill::internal {

// Collects in `open` the leaves that are not proven to stay at least `distance` (mm, > 0) away from the move
// a b with everything above it. All other leaves are proven. Returns false if it meets a surface point nearer
// than `distance`; `open` is then meaningless. Cost: one walk over the tree, and a few bounds at centres on
// the move for each leaf met.
//
// Proof for a leaf. At centres on the move its distance is bounded from below by its oriented box, by its
// second-order model (LeastOn), or from f and its slope near the minimum (LeastFrom; if f is convex on the
// leaf, also the tangent plane). Between two centres [location T2a] bounds it (ChordDistance2). Intervals are
// halved until that suffices, or until [location T2a] loses less than `spare` (mm) of the distance.
bool CollectSweptLeaves(const Locator::Impl& impl, const Vec3& a, const Vec3& b, double distance,
                        double spare, std::vector<std::int32_t>& open);

}  // namespace patchmill::internal
