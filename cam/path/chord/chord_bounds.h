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

// [location T2b]: returns an upper bound (mm) for the gouge of the straight move a b, given free centres near
// it. `free` holds one or more centres at which the ball is free with its upward sweep, in the order of the
// move. The first lies at or right below a, the last at or right below b. With two centres the bound is
// sharp. Proof: a point x of the move that is at or right above a free centre is at least R from every
// surface point and from all places below surface points. A point x at the distance r from a free centre is
// at least R - r from them. Between two such points [location T2a] holds (ChordDistance2).
double ChordGouge(double radius, const Vec3& a, const Vec3& b, std::span<const Vec3> free);

// The longest chord with ChordGouge <= tolerance. `tolerance` is clamped to [0, radius].
double LongestChord(double radius, double tolerance);

// A ball rests on a support: a surface point or, without a contact, the floor plane (PassParams::floor_z).
struct Support {
  std::optional<Vec3> contact;
  double floor_center = -kInfinity;  // mm: centre height of a ball on the floor, used if there is no contact

  // Distance (mm) of a ball centred at x from this support; negative where it enters the support.
  double Clearance(const Vec3& x, double radius) const {
    return contact ? (x - *contact).norm() - radius : x.z() - floor_center;
  }
};

// [location T3]: returns an upper bound (mm) for the excess of the chord a b, whatever surface lies between
// the supports of its ends. The chord is split at one point; the first part is compared with at_a, the second
// with at_b. On each part the clearance from the support is convex, so it is largest at an end of the part.
// The split is the one that makes the bound smallest. The bound may be negative: then every ball on the chord
// enters a support.
double ChordExcess(double radius, const Vec3& a, const Vec3& b, const Support& at_a, const Support& at_b);

}  // namespace patchmill
