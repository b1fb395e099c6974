// Passes around rims instead of across them.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/locator.h"
#include "cam/path/edge/border_places.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Where walls end in an open rim lines that do nothing but roll over it, from one side to the other, are as
// short as the ball is wide and lie a few millimetres apart: each needs a way in and out. Those that follow
// each other along one of `borders`, two or more, no more than two ball radii apart, are taken out of
// `paths`, and a pass above the rim itself, from a little before the first to a little after the last or all
// around, is returned for them. Between it and a pass that rolls on to 45 degrees from the vertical nothing
// stays of a layer on the rim that is thinner than the ball's radius. Lines that touch the surface in its own
// normal anywhere stay. With params.roll nothing is done: that rule asks for more than to stand above a rim.
// Certified to params.chord_tolerance. Deterministic. Cost: a closest point for every half ball radius of
// lines that begin in a roll. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<CutterPath>> RimPasses(const Locator& locator,
                                                  const std::vector<BorderCurve>& borders,
                                                  const PassParams& params, const RunContext& run,
                                                  std::vector<CutterPath>& paths);

}  // namespace patchmill
