// Passes along borders. Where lines run nearly parallel to the border of their area, they end there one after
// the other, and steps stay between their ends. One pass along the border finishes these steps.
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

// Returns passes along those stretches of `borders` that `paths` leave unfinished beside zig-zag lines. On
// such a stretch the nearest zig-zag line is at most two flat step-overs away and runs along the border
// (kAlongBorder), and somewhere no pass of any kind is within 0.55 flat step-overs. Stretches shorter than
// four flat step-overs get no pass; neither do places at which the ball cannot touch the border (creases,
// undercuts). Passes are certified to params.chord_tolerance, as lines are. They come in the order of the
// borders. Deterministic, parallel over the borders.
absl::StatusOr<std::vector<CutterPath>> BorderPasses(const Locator& locator,
                                                     const std::vector<BorderCurve>& borders,
                                                     const std::vector<CutterPath>& paths,
                                                     const PassParams& params, const RunContext& run);

}  // namespace patchmill
