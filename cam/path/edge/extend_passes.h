// Edge rule EXTEND: passes run on beyond the border they end at.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/location/locator.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Adds to each end of an open pass whose contact lies on an open border a straight move of `length` (mm) in
// the direction of the pass there, or of a half or a quarter of it: the longest that gouges nothing by more
// than params.chord_tolerance (swept ball, with what hangs above it), stays above the floor, where
// `operation_limits` allows (null: anywhere), and off ground that is not wanted but for a step. Its end
// touches
// nothing. Deterministic, parallel over passes.
absl::StatusOr<std::vector<CutterPath>> ExtendPasses(const Locator& locator, std::vector<CutterPath> paths,
                                                     double length, const PassParams& params,
                                                     const OperationLimits* operation_limits,
                                                     const RunContext& run);

}  // namespace patchmill
