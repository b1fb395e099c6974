// Where a ball that nearly fits over a surface point can stand.
#pragma once

#include <optional>

#include "cam/location/locator.h"

namespace patchmill {

// The free centre (whole radius, nothing above it, z >= lowest_z) nearest to the surface point p, on the side
// of the unit normal n there; exact where planes are in the way, else near it. Where obstacles push along n
// and sideways it gives way sideways, which leaves the square of it at p. nullopt when it would leave more
// than `most` mm at p, or is not found. With `gouge` (mm, proven) also where the ball goes that far into what
// is in its way: in a slot or a hole as wide as the ball no centre is free but for rounding. `wedged`: all
// that is in the way gives in by as much, so that between walls which are nearer to each other than the ball
// is wide there is a centre at all. Cost: some ten microseconds for each of the few obstacles met.
std::optional<Vec3> FreeCenterNear(const Locator& locator, const Vec3& p, const Vec3& n, double lowest_z,
                                   double most, double gouge = 0.0, bool wedged = false);

}  // namespace patchmill
