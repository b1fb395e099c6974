// Contours one below the other wound into one pass: no marks where the ball goes from level to level.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/locator.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Closed contours of consecutive lines (ContourPaths) that run beside each other all the way round become one
// open path with `spiral` set: the highest as it is, from there down turn by turn, the lowest as it is. Turn
// k falls from level k to level k + 1 evenly with its length, so that two turns are nowhere farther apart
// than the levels above and below them. Every vertex lies on the contour of its own height, solved as
// contours are (LevelOracle::Exit), and every chord keeps params.chord_tolerance on both sides
// ([location T2]; T3 on the contacts of its ends). Where contours part, join or end, or a chord cannot be
// proven, they stay as they are. The other paths come back unchanged, in their order; a spiral takes the
// place of its highest contour, with its line. `backwards`: wound against the direction of the contours.
// Deterministic; cost of one exit a vertex, parallel over the turns. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<CutterPath>> SpiralPaths(const Locator& locator, std::vector<CutterPath> contours,
                                                    const PassParams& params, bool backwards,
                                                    const RunContext& run);

}  // namespace patchmill
