// Where a ball touches the surface, when that is more than one place.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

inline constexpr double kContactReach = 1.1;  // of the radius: nothing farther counts

// The nearest point of the surface to c, and up to three more that are as near to within `slack` (mm, from
// 0.002 to 0.04 `radius`) and lie more than a tenth of a radius apart: the floor, and the walls around it.
// None farther than kContactReach. A place is found from a little off those known before: what lies between
// two others may be missed. Cost: a closest point for each, and one more.
std::vector<SurfacePoint> ContactPoints(const Surface& surface, const Vec3& c, double radius, double slack);

}  // namespace patchmill
