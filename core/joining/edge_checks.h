// Checks that the numbers which describe the edges of a curve network make curves.
#pragma once

#include "core/joining/network_findings.h"

namespace patchmill {

// Codes: NOT_FINITE, ZERO_TANGENT, INVALID_GAMMA (outside (0, 10]), INVALID_PARAMETER, UNSUPPORTED_CURVE
// (degree outside 1..kMaxBrownDegree, wrong number of points or knots, knots that decrease or span nothing).
// An edge without a finding may be evaluated.
void CheckEdgeShapes(const CurveNetwork& network, const NetworkWriter& findings);

}  // namespace patchmill
