// Decides whether a distance form is nowhere negative. If a ball touches a surface along a line, no plane
// supports the form strictly, and DecideConvex cannot decide. The coefficients of the form's halves approach
// the form quadratically, and cuts across the line alone suffice.
#pragma once

#include "core/surface/distance_form.h"

namespace patchmill {

// Halves the form into parts. True is proven: no coefficient of any part is below the bound of rounding.
// False: the form is negative somewhere, or nothing could be proven within `most_parts` parts. A place where
// the form touches zero takes about 40 parts for each direction in which the form grows. A line along the
// other parameter takes no more, a slanting line takes far more. Cost per part:
// (degree_u + 1)(degree_v + 1)(degree_u or degree_v) sums.
bool NowhereNegative(const DistanceForm& form, int most_parts);

}  // namespace patchmill
