// Points of the surface between the contacts of a chord's ends, as further supports for [location T3]. With
// the two contacts alone T3 counts an excess of L^2 / (8 R) for a chord of length L even on a plane, where
// there is none. With enough points in between it comes near the true excess [location (10)].
#pragma once

#include <span>
#include <vector>

#include "cam/location/locator.h"
#include "cam/path/chord/chord_bounds.h"

namespace patchmill {

// Number of parts into which the way between the contacts of two centres `length` apart (mm) is divided, so
// that [location T3] counts at most a third of `excess` (mm, > 0) on a plane. 2 to 16.
int SupportParts(double radius, double length, double excess);

// Returns the `parts` - 1 points of the surface that divide the way between two contacts on one piece evenly
// in its parameters. Any surface point is a true support; these lie about where the ball touches.
std::vector<Support> SupportsBetween(const Surface& surface, const SurfacePoint& a, const SurfacePoint& b,
                                     int parts, double floor_center);

// A chord from a to b, with what the ball touches at its ends and between them. `between` refers to supports
// that must outlive it.
struct SupportedChord {
  Vec3 a, b;
  Support at_a, at_b;
  std::span<const Support> between;
};

// Returns true if the excess of the chord is proven to be at most `limit` (mm). The supports, at_a and at_b
// included, divide the chord into equal stretches; [location T3] is applied to each stretch with the supports
// of its ends.
bool ExcessWithin(double radius, const SupportedChord& chord, double limit);

}  // namespace patchmill
