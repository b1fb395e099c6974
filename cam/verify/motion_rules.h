// [verification P3] as far as the motion alone can break it: how it starts and ends, how it descends, how low
// it goes.
#pragma once

#include "cam/verify/motion_figures.h"

namespace patchmill {

// One error for each rule that is broken, with the line: FIRST_MOTION_NOT_UP, LAST_MOTION_NOT_UP (nor if it
// ends below the stock's top), SPINDLE_LEFT_ON, COOLANT_LEFT_ON, UNKNOWN_START (below the stock's top from an
// X or Y that was never stated), BELOW_FLOOR, STEEP_DESCENT. `motion` has moves.
Diagnostics BrokenMotionRules(const ProgramMotion& motion, const Tool& tool, const VerifyParams& params,
                              const MotionFigures& figures);

}  // namespace patchmill
