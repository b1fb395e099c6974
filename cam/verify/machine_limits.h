// Compares a program with the machine that runs it.
#pragma once

#include "cam/toolpath/machine.h"
#include "cam/toolpath/toolpath.h"
#include "core/base/diagnostic.h"

namespace patchmill {

// Returns one error with its program line for each limit that the motion exceeds, at most one for each axis,
// and one for the spindle:
// - BEYOND_TRAVEL: the places of the tip lie farther apart than the axis travels. If the machine states the
//   program zero, a place beyond the travel is an error, too. Moves to machine zero do not count, because its
//   place is not known.
// - FEED_BEYOND_RANGE: a feed is faster than the axis may go.
// - SPINDLE_BEYOND_RANGE: at a feed, the spindle turns slower or faster than it may.
// Cost O(moves).
Diagnostics BeyondMachine(const ProgramMotion& motion, const Machine& machine);

}  // namespace patchmill
