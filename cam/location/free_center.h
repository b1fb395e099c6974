// Finds where a ball that nearly fits over a surface point can stand.
#pragma once

#include <optional>

#include "cam/location/locator.h"

namespace patchmill {

struct FreeCenterLimits {
  double lowest_z = -kInfinity;  // mm, lowest centre height
  double most = 0.0;             // mm, what the centre may leave at the surface point
  // mm, >= 0, proven: so much the ball may penetrate obstacles. In a slot or a hole as wide as the ball, no
  // centre is free except by rounding.
  double gouge = 0.0;
  // All obstacles yield by about `gouge`. So a centre exists even between walls that are closer together than
  // the ball is wide.
  bool wedged = false;
};

// The free centre nearest to the surface point p, on the side of the unit normal n there. Free means: the
// whole radius, nothing above it, not below limits.lowest_z. It is exact where planes are in the way,
// otherwise close to it. Where obstacles push the centre along n and sideways, it moves sideways, which
// leaves only the square of the shift at p. Returns nullopt if the centre would leave more than
// limits.most at p, or if none is found. Cost: some ten microseconds for each of the few obstacles met.
std::optional<Vec3> FreeCenterNear(const Locator& locator, const Vec3& p, const Vec3& n,
                                   const FreeCenterLimits& limits);

}  // namespace patchmill
