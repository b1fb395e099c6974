// Borders as polylines in space, and lines through places of them.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

// A border on the surface; closed: the last point joins the first, which is not repeated.
struct BorderCurve {
  std::vector<Vec3> points;
  bool closed = false;
};

// Places `spacing` (mm) apart, a little less on the last bit; both ends of an open curve, the first one twice
// of a closed one.
std::vector<Vec3> PlacesOn(const BorderCurve& border, double spacing);

// Fewest of `places`, the first and the last among them, that stay within `tolerance` (mm) of all. At least
// one place.
std::vector<Vec2> Thinned(const std::vector<Vec2>& places, double tolerance);

}  // namespace patchmill
