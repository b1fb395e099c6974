// Winds contours that lie one below the other into one pass, without marks where the ball changes levels.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/locator.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Closed contours of consecutive levels (ContourPaths) that run beside each other all the way round become
// one open path with `spiral` set. It keeps the highest contour as it is, falls turn by turn from there, and
// keeps the lowest as it is. Turn k falls from level k to level k + 1 evenly with its length, so that two
// turns are nowhere farther apart than the levels above and below them. Every vertex lies on the contour of
// its own height, solved as contours are (LevelOracle::Exit). Every chord keeps params.chord_tolerance on
// both sides ([location T2]; T3 on the contacts of its ends). Where contours part, join or end, or a chord
// cannot be proven, they stay as they are. The other paths come back unchanged, in their order; a spiral
// takes the place of its highest contour, with its order key. `backwards` winds against the direction of the
// contours. Deterministic. Cost: one exit a vertex, parallel over the chains of turns. Errors: CANCELLED or
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<CutterPath>> SpiralPaths(const Locator& locator, std::vector<CutterPath> contours,
                                                    const PassParams& params, bool backwards,
                                                    const RunContext& run);

}  // namespace patchmill
