// Ground that a forced strategy is not for: reason STRATEGY of the report.
#pragma once

#include "cam/verify/leftover.h"

namespace patchmill {

// True when a forced strategy cannot finish here, from either side of an upright face: the centre step it
// would need ([spacing (3)]) is below min_step_fraction of the flat one, with a margin of 10 %.
bool BeyondStrategy(const SurfaceJet& jet, const Facing& facing, const LeftoverParams& params);

}  // namespace patchmill
