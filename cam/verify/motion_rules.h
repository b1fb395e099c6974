// Checks the rules of [verification P3] that depend on the motion alone: its start and end, its lowest place.
#pragma once

#include "cam/verify/motion_figures.h"

namespace patchmill {

// Returns one error with its program line for each rule that is broken: FIRST_MOTION_NOT_UP,
// LAST_MOTION_NOT_UP (also if the program ends below the stock's top), SPINDLE_LEFT_ON, COOLANT_LEFT_ON,
// UNKNOWN_START (a move below the stock's top from an X or Y that was never stated), SPINDLE_STOPPED (during
// a feed below the stock's top), BELOW_FLOOR. `motion` must have moves.
Diagnostics BrokenMotionRules(const ProgramMotion& motion, const VerifyParams& params,
                              const MotionFigures& figures);

}  // namespace patchmill
