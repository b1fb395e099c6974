// Finds places that a forced strategy is not meant for: reason STRATEGY of the report.
#pragma once

#include "cam/verify/leftover.h"

namespace patchmill {

// True if the forced strategy cannot finish this place: the centre step that it would need [spacing (3)] is
// below 1.1 min_step_fraction of the step on a plane. On a vertical face with two sides this must hold for
// both.
bool BeyondStrategy(const SurfaceJet& jet, const Facing& facing, const LeftoverParams& params);

}  // namespace patchmill
