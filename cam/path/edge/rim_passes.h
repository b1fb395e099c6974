// Replaces short lines across rims by passes along the rims.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/locator.h"
#include "cam/path/edge/border_places.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// A wall that ends at the top in an open rim is crossed by lines that only roll over the rim, from one side
// to the other. Such lines are as short as the ball is wide, lie a few millimetres apart, and each needs an
// approach and a retract. Where two or more of them follow each other along one of `borders`, at most two
// ball radii apart, they are removed from `paths`, and one pass above the rim is returned instead. It runs
// from a little before the first line to a little after the last, or all around the border. Material on the
// rim that is thinner than the ball's radius is removed by it, together with the passes beside it that roll
// on to 45 degrees from the vertical.
//
// A line that touches a face in its normal anywhere stays. With params.roll nothing is done, since that rule
// requires more than a pass above the rim. Passes are certified to params.chord_tolerance. Deterministic.
// Cost: one closest point for every half ball radius of the lines that begin on a rim. Errors: CANCELLED or
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<CutterPath>> RimPasses(const Locator& locator,
                                                  const std::vector<BorderCurve>& borders,
                                                  const PassParams& params, const RunContext& run,
                                                  std::vector<CutterPath>& paths);

}  // namespace patchmill
