// Passes along borders: where lines run along the border of what they cover they end one after the other, and
// a pass along the border itself finishes the steps between their ends in one go.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/locator.h"
#include "cam/path/edge/border_places.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Lines within this angle (rad, in plan) of a border run along it.
inline constexpr double kAlongBorder = 0.35;

// Of those of `paths` that are lines: a pass that touches each stretch of `borders` along which the nearest
// line, at most two flat steps away, runs, and which the lines leave: somewhere on it the nearest pass is
// more than half a flat step away. Stretches shorter than four flat steps need none; nor is there one where
// the ball cannot touch the border (creases, undercuts). Certified to params.chord_tolerance, as lines are.
// In the order of the borders; deterministic, parallel over them.
absl::StatusOr<std::vector<CutterPath>> BorderPasses(const Locator& locator,
                                                     const std::vector<BorderCurve>& borders,
                                                     const std::vector<CutterPath>& paths,
                                                     const PassParams& params, const RunContext& run);

}  // namespace patchmill
