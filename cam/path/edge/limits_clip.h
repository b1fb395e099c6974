// The parts of passes that an operation wants and allows.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Flat steps from what is wanted to what may be touched beyond it, by passes clipped at one step and what is
// added to their ends: links, run-ons.
inline constexpr double kOverrun = 1.25;

// Keeps what is allowed all the way (OperationLimits::AllowsMove; ends within 1e-3 mm of the limit) and
// touches the
// surface within `reach` (mm) of a point to be finished, looked for every half `reach` along the pass and
// ended at to a thirtieth of it. A ball that touches unwanted ground is tangent to it: running on for `reach`
// leaves no ridge at the seam and takes nothing that is not to go. Order and direction stay; a closed path
// that stays whole stays closed. Parallel over paths, deterministic.
absl::StatusOr<std::vector<CutterPath>> ClipToLimits(const Locator& locator,
                                                     const OperationLimits& operation_limits,
                                                     std::vector<CutterPath> paths, double reach,
                                                     const RunContext& run);

}  // namespace patchmill
