// Certified bounds for a straight move of the ball centre ([location, section 3]): closed forms, no surface
// evaluation.
#pragma once

#include <optional>
#include <span>

#include "core/base/segment.h"
#include "core/base/vec.h"

namespace patchmill {

// [location T2]: two gouge-free centres `length` apart (mm) are joined by a chord that gouges at most this
// much. Returns `radius` when length >= 2 radius: nothing is known there.
double ChordGouge(double radius, double length);

// [location T2b]: the largest gouge of the straight move a b when the balls at all of `free` (and everything
// above them) are free. `free` holds at least one centre, in the order of the move; the first lies at or
// below a, the last at or below b. Sharp for two. Proof: a point x of the move at a free centre, or above
// one, is at least R from every surface point (and from what hangs below it); any other x is at least R - |x
// - centre| from it. Between two such places [location T2a] holds (ChordDistance2).
double ChordGouge(double radius, const Vec3& a, const Vec3& b, std::span<const Vec3> free);

// The longest chord with ChordGouge <= tolerance. `tolerance` is clamped to [0, radius].
double LongestChord(double radius, double tolerance);

// What a resting ball touches: a surface point, or (no `contact`) the floor plane that carries its centre.
struct Support {
  std::optional<Vec3> contact;
  double floor_center = -kInfinity;  // centre height on the floor, used when `contact` is absent

  // Distance (mm) of a ball centred at x from this support; negative where it enters the support.
  double Clearance(const Vec3& x, double radius) const {
    return contact ? (x - *contact).norm() - radius : x.z() - floor_center;
  }
};

// [location T3] in space: every point x of the chord a b is within the returned distance (mm) of touching one
// of the two supports, whatever lies between them. The bound is exact for this pair up to the choice of one
// split point: both clearances are convex along the chord, so their values at the ends and at the split bound
// them. It may be negative.
double ChordExcess(double radius, const Vec3& a, const Vec3& b, const Support& at_a, const Support& at_b);

}  // namespace patchmill
