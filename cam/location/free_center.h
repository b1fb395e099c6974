// Finds where a ball that nearly fits over a surface point can stand.
#pragma once

#include <optional>

#include "cam/location/locator.h"

namespace patchmill {

// The free centre nearest to the surface point p, on the side of the unit normal n there. Free means: the
// whole radius, nothing above it, z >= lowest_z. It is exact where planes are in the way, otherwise close to
// it. Where obstacles push the centre along n and sideways, it moves sideways, which leaves only the square
// of the shift at p. Returns nullopt if the centre would leave more than `most` mm at p, or if none is found.
//
// With `gouge` (mm, proven) the ball may also penetrate obstacles by this much. In a slot or a hole as wide
// as the ball, no centre is free except by rounding. With `wedged` all obstacles yield by about this much. So
// a centre exists even between walls that are closer together than the ball is wide. Cost: some ten
// microseconds for each of the few obstacles met.
std::optional<Vec3> FreeCenterNear(const Locator& locator, const Vec3& p, const Vec3& n, double lowest_z,
                                   double most, double gouge = 0.0, bool wedged = false);

}  // namespace patchmill
