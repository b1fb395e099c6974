// The parts of passes that an operation wants and allows.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Flat step-overs: how far beyond the selected surface the tool may touch. Passes are clipped at one step;
// links and extensions add to their ends.
inline constexpr double kOverrun = 1.25;

// Keeps the parts of passes that are allowed all the way (OperationLimits::AllowsMove; ends within 1e-3 mm of
// the limit) and touch the surface within `reach` (mm) of a point to be finished. The latter is tested every
// half `reach` along the pass, and ends are placed to a thirtieth of it. A ball that touches surface that is
// not selected is tangent to it, so an overrun of `reach` leaves no ridge at the seam and removes nothing
// that must stay. Order and direction stay; a closed path that stays whole stays closed. Parallel over paths,
// deterministic.
absl::StatusOr<std::vector<CutterPath>> ClipToLimits(const Locator& locator,
                                                     const OperationLimits& operation_limits,
                                                     std::vector<CutterPath> paths, double reach,
                                                     const RunContext& run);

}  // namespace patchmill
