// A spline surface by one of lower degrees, where the degrees of its own are too high for strips.
#pragma once

#include <absl/status/statusor.h>

#include "core/trim/carrier_grid.h"

namespace patchmill {

// Both degrees of the carriers of a lowered grid are at most this: strips of them may have quadratic borders.
inline constexpr int kLoweredDegree = 5;

struct LoweredGrid {
  CarrierGrid grid;
  double error = 0.0;  // mm, a bound of the distance between both surfaces at the same parameters
};

// The grid of a spline with degrees of at most kLoweredDegree: carriers of higher degree are halved along
// that parameter until each half is within `tolerance` (mm, > 0) of a polynomial or rational patch that
// keeps its ends and their first derivatives, by least squares between them. Parameters stay, and carriers
// that share a side still do. The bound follows from the control points of the difference.
// FAILED_PRECONDITION if 2^8 parts are not enough. Cost about 1 ms for each carrier of degree 14.
absl::StatusOr<LoweredGrid> WithLowerDegrees(const CarrierGrid& grid, double tolerance);

}  // namespace patchmill
