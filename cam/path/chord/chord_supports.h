// Points of the surface between two contacts, so many that [location T3] over them tells the true excess of a
// chord from that of its length ([location (10)]): T3 alone counts L^2 / 8 R on a plane.
#pragma once

#include <span>
#include <vector>

#include "cam/location/locator.h"
#include "cam/path/chord/chord_bounds.h"

namespace patchmill {

// Into how many parts the way between the contacts of two centres `length` apart is divided, so that what
// [location T3] counts on a plane is a third of `excess` (mm, > 0) at most. 2 to 16.
int SupportParts(double radius, double length, double excess);

// The `parts` - 1 points of the surface that divide the way between two contacts on one piece evenly by its
// parameters. Any surface point is a true support; these lie about where the ball touches.
std::vector<Support> SupportsBetween(const Surface& surface, const SurfacePoint& a, const SurfacePoint& b,
                                     int parts, double floor_center);

// [location T3] over many supports, each serving an equal stretch of the chord with the next: does the excess
// stay within `limit`?
bool ExcessWithin(double radius, const Vec3& a, const Vec3& b, const Support& at_a,
                  std::span<const Support> between, const Support& at_b, double limit);

}  // namespace patchmill
