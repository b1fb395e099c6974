// v1.OutlineCurve -> curves in mm.
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/crossing/drawn_curve.h"
#include "patchmill/v1/outline.pb.h"

namespace patchmill {

// Reads a list of curves. `at` is the path of the message that has it as `curves`. INVALID_ARGUMENT lists all
// wrong fields. RESOURCE_EXHAUSTED for a limit, before anything is copied.
absl::StatusOr<std::vector<Curve>> CurvesOf(
    const google::protobuf::RepeatedPtrField<v1::OutlineCurve>& curves, double unit, const std::string& at);

struct DrawnCurves {
  std::vector<DrawnCurve> curves;
  Diagnostics findings;  // STROKE_OF_ONE_POINT, a warning: such strokes are left out
};

// The curves of `crossing` with their ids, those of its strokes after them.
absl::StatusOr<DrawnCurves> DrawnCurvesOf(const v1::CrossingCurves& crossing, double unit);

}  // namespace patchmill
