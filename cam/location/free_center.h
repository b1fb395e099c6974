// Finds the free centre nearest to a surface point, for a ball that nearly fits there.
#pragma once

#include <optional>

#include "cam/location/locator.h"

namespace patchmill {

struct FreeCenterLimits {
  double lowest_z = -kInfinity;  // mm, lowest centre height
  double most = 0.0;             // mm: largest leftover at the surface point, |centre - p| - R
  // mm, >= 0: so deep may the surface lie inside the ball; this is proven. In a slot or a hole as wide as the
  // ball no centre is free without it, except by rounding.
  double gouge = 0.0;
  // True: count on the whole `gouge` at every obstacle from the start. Then a centre is found between walls
  // that are a little closer together than the ball is wide. False: `gouge` is used only if no free centre is
  // found.
  bool wedged = false;
};

// Returns the free centre nearest to the surface point p, on the side of the unit normal n there, at or above
// limits.lowest_z. The ball has the radius of the locator; its upward sweep is free, too, both up to
// limits.gouge. If only planes are in the way the centre is the nearest one exactly, otherwise nearly. It
// gives way to obstacles sideways where it can, since a sideways shift d leaves only about d^2 / (2 R) at p.
// nullopt if the centre would leave more than limits.most at p, or if none is found. Cost: some ten
// microseconds for each of the few obstacles met.
std::optional<Vec3> FreeCenterNear(const Locator& locator, const Vec3& p, const Vec3& n,
                                   const FreeCenterLimits& limits);

}  // namespace patchmill
