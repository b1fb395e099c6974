// Is a distance form nowhere negative? Where a ball touches a surface along a line no plane supports the
// form strictly (DecideConvex), but halves of its coefficients come near it quadratically, and cut across
// the line only.
#pragma once

#include "core/surface/distance_form.h"

namespace patchmill {

// True is proven: no coefficient of the parts the form is divided into, by halves, is below what rounding
// explains. False: it is negative somewhere, or nothing could be proven within `most_parts`: a place where it
// touches zero takes about 40 of them for each direction in which it grows, a line along the other parameter
// no more, a slanting one far more. Cost (degree_u + 1)(degree_v + 1)(degree_u or degree_v) sums a part.
bool NowhereNegative(const DistanceForm& form, int most_parts);

}  // namespace patchmill
