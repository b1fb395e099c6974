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

struct ExtendParams {
  PassParams pass;
  double length = 0.0;                                // mm, of a move beyond the edge
  const OperationLimits* operation_limits = nullptr;  // what is wanted and allowed; null: everything
};

// Adds a straight move to each end of an open pass whose contact lies on an open edge. The move has the
// direction of the pass there and params.length, or a half or a quarter of it. The longest one is taken that
// gouges nothing by more than the chord tolerance (swept ball, with what hangs above it), stays above the
// floor, stays where the operation's limits allow, and runs over surface that is not selected by at most a
// step. The end of the move touches nothing. Deterministic, parallel over passes.
absl::StatusOr<std::vector<CutterPath>> ExtendPasses(const Locator& locator, std::vector<CutterPath> paths,
                                                     const ExtendParams& params, const RunContext& run);

}  // namespace patchmill
