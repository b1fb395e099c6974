// Borders as polylines in space, and places on them.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

// A border on the surface. If closed, the last point joins the first, which is not repeated.
struct BorderCurve {
  std::vector<Vec3> points;
  bool closed = false;
};

// Returns places `spacing` (mm) apart, the last gap being shorter. Both ends of an open curve are among them;
// of a closed curve the first place is also the last.
std::vector<Vec3> PlacesOn(const BorderCurve& border, double spacing);

// Returns the fewest of `places` whose polyline stays within `tolerance` (mm) of all. The first and the last
// are kept. There must be at least one place.
std::vector<Vec2> Thinned(const std::vector<Vec2>& places, double tolerance);

}  // namespace patchmill
