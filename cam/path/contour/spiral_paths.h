// Winds contours that lie one below the other into one pass, without marks where the ball changes levels.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/locator.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Replaces closed contours of consecutive levels (ContourPaths) that run beside each other all the way round
// by one open path with `spiral` set, a helical pass. The path consists of the highest contour, one turn for
// each gap between two levels, and the lowest contour. Turn k falls from level k to level k + 1 evenly with
// its length, so two turns are nowhere farther apart than the levels above and below them. Every vertex lies
// on the waterline of its own height and is solved like one of a contour (LevelOracle::Exit). Every chord
// keeps params.chord_tolerance: its gouge by [location T2], its excess by [location T3] with the contacts of
// its ends. Contours that part, join or end stay contours, and so do those for which a chord cannot be
// proven. Other paths come back unchanged, in their order. A spiral takes the place and the order key of its
// highest contour. `backwards`: the spiral runs against the direction of the contours. Deterministic. Cost:
// one LevelOracle::Exit for each vertex; spirals are made in parallel. Errors: CANCELLED or DEADLINE_EXCEEDED
// from `run`.
absl::StatusOr<std::vector<CutterPath>> SpiralPaths(const Locator& locator, std::vector<CutterPath> contours,
                                                    const PassParams& params, bool backwards,
                                                    const RunContext& run);

}  // namespace patchmill
