// Passes along borders. Where lines run along the border of their area they end one after the other. A pass
// along the border finishes the steps between their ends in one go.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/locator.h"
#include "cam/path/edge/border_places.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// rad, in plan: lines within this angle of a border run along it.
inline constexpr double kAlongBorder = 0.35;

// Returns passes that touch stretches of `borders` which lines leave unfinished. Of `paths` only lines count.
// On such a stretch the nearest line, at most two flat step-overs away, runs along the border, and somewhere
// the nearest pass is more than 0.55 flat step-overs away. Stretches shorter than four flat step-overs get no
// pass, nor do places where the ball cannot touch the border (creases, undercuts). Passes are certified to
// params.chord_tolerance, as lines are. They come in the order of the borders. Deterministic, parallel over
// the borders.
absl::StatusOr<std::vector<CutterPath>> BorderPasses(const Locator& locator,
                                                     const std::vector<BorderCurve>& borders,
                                                     const std::vector<CutterPath>& paths,
                                                     const PassParams& params, const RunContext& run);

}  // namespace patchmill
