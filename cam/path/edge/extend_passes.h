// Edge rule EXTEND: passes continue beyond the open edge at which they end.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/location/locator.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Adds a straight move to each end of an open pass whose contact lies on an open edge. The move has the
// direction of the pass there and `length` (mm), or a half or a quarter of it. The longest one is taken that
// gouges nothing by more than params.chord_tolerance (swept ball, with what hangs above it), stays above the
// floor, stays where `operation_limits` allows (null: anywhere), and runs over surface that is not selected
// by at most a step. The end of the move touches nothing. Deterministic, parallel over passes.
absl::StatusOr<std::vector<CutterPath>> ExtendPasses(const Locator& locator, std::vector<CutterPath> paths,
                                                     double length, const PassParams& params,
                                                     const OperationLimits* operation_limits,
                                                     const RunContext& run);

}  // namespace patchmill
