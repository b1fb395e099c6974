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

// Where walls end in an open rim, lines that only roll over it from one side to the other are as short as the
// ball is wide and lie a few millimetres apart. Each needs an approach and a retract. If two or more of them
// follow each other along one of `borders`, at most two ball radii apart, they are taken out of `paths`. For
// them a pass above the rim is returned, from a little before the first to a little after the last, or all
// around. Together with a pass that rolls on to 45 degrees from the vertical it leaves nothing of a layer on
// the rim that is thinner than the ball's radius. Lines that touch the surface in its own normal anywhere
// stay. With params.roll nothing is done: that rule requires more than a pass above the rim. Passes are
// certified to params.chord_tolerance. Deterministic. Cost: a closest point for every half ball radius of
// lines that begin in a roll. Errors: CANCELLED or DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<CutterPath>> RimPasses(const Locator& locator,
                                                  const std::vector<BorderCurve>& borders,
                                                  const PassParams& params, const RunContext& run,
                                                  std::vector<CutterPath>& paths);

}  // namespace patchmill
