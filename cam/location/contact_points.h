// Finds the contacts of a ball that touches the surface at more than one place.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

inline constexpr double kContactReach = 1.1;  // in radii; no contact is farther away

// Returns the contacts of the ball of `radius` (mm) at the centre c: the surface point nearest to c, and up
// to three others, as on a floor and the walls around it. The others are farther from c than the nearest one
// by at most `slack` (mm, 0.002 to 0.04 radii), no contact is farther than kContactReach, and all are more
// than a tenth of a radius apart. Each further contact is searched from a place shifted away from the known
// ones, so a contact between two others may be missed. Cost: one closest point for each contact, and one
// more.
std::vector<SurfacePoint> ContactPoints(const Surface& surface, const Vec3& c, double radius, double slack);

}  // namespace patchmill
