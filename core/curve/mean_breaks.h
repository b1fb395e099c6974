// Section curves in one parameter, so that a skin over them has one set of knots.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/curve/bezier_chain.h"

namespace patchmill {

// Cubic splines through the ends of the spans of each chain, with the end tangents of the chain. Their
// breaks are the means of those of all chains. (Piegl and Tiller, The NURBS Book, section 10.3.) Chains
// that measured points made so differ from their splines between the points only. INVALID_ARGUMENT for
// numbers of spans that differ. Cost O(points).
absl::StatusOr<std::vector<BezierChain>> WithMeanBreaks(const std::vector<BezierChain>& chains);

}  // namespace patchmill
