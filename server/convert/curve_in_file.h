// Curves that a request brings as the bytes of a file.
#pragma once

#include <absl/status/statusor.h>

#include "core/curve/bezier_chain.h"
#include "patchmill/v1/network.pb.h"

namespace patchmill {

// The curve in mm: the `curve` of a FairCurveResponse, which is in mm, or the cubic spline through points,
// whose unit is `unit` mm. INVALID_ARGUMENT completes "<field> ...": "has no content; ...".
absl::StatusOr<BezierChain> CurveIn(const v1::CurveInFile& file, double unit);

// The same curve as one that a network or an outline takes.
BsplineCurve AsBspline(const BezierChain& chain);

}  // namespace patchmill
