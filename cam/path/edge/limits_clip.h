// Clips passes to what an operation wants and allows.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Flat step-overs: how far beyond the selected surface the tool may touch the part. Passes are clipped at one
// step beyond it; the rest is for links and extensions at their ends.
inline constexpr double kOverrun = 1.25;

// Returns the parts of `paths` that fulfil two conditions. Every move is allowed
// (OperationLimits::AllowsMove); a part ends within 1e-3 mm of the limit. And the ball touches the surface
// within `reach` (mm) of a point to be finished; this is tested every half `reach` along the pass, and a part
// ends within a thirtieth of `reach` of where it fails. So passes overrun the selected surface by `reach`,
// and no ridge stays at its border. The overrun gouges nothing, since the ball is tangent to the surface
// there, too. Order and direction stay. A closed path that is kept whole stays closed. Parallel over paths,
// deterministic.
absl::StatusOr<std::vector<CutterPath>> ClipToLimits(const Locator& locator,
                                                     const OperationLimits& operation_limits,
                                                     std::vector<CutterPath> paths, double reach,
                                                     const RunContext& run);

}  // namespace patchmill
