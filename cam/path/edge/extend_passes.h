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

// Adds a straight move to each end of an open pass at which the contact lies on an open edge. The move
// continues the pass in its direction there. Its length is params.length, or half or a quarter of it: the
// longest with which the move gouges nothing by more than the chord tolerance (upward sweep included), stays
// above the floor and within the operation's limits, and touches no surface farther than kOverrun flat
// step-overs beyond the selected one. The end of the move has no contact. Deterministic, parallel over
// passes.
absl::StatusOr<std::vector<CutterPath>> ExtendPasses(const Locator& locator, std::vector<CutterPath> paths,
                                                     const ExtendParams& params, const RunContext& run);

}  // namespace patchmill
