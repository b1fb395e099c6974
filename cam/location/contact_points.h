// The places where a ball touches the surface, if there is more than one.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

inline constexpr double kContactReach = 1.1;  // in radii; no contact is farther away

// The surface point nearest to c, and up to three more: for instance the floor and the walls around it. Their
// distances are the same to within `slack` (mm, 0.002 to 0.04 `radius`), and they are more than a tenth of a
// radius apart. None is farther than kContactReach. Each further place is searched from a point a little away
// from the known ones, so a place between two others may be missed. Cost: one closest point for each, and one
// more.
std::vector<SurfacePoint> ContactPoints(const Surface& surface, const Vec3& c, double radius, double slack);

}  // namespace patchmill
