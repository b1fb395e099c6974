// P3 for the operation's own limits: no feed outside the boundary, nothing in an obstacle.
#pragma once

#include "cam/toolpath/toolpath.h"
#include "cam/verify/reach.h"

namespace patchmill {

// OBSTACLE_HIT (all moves) and OUTSIDE_BOUNDARY (feed moves), the deepest first, one a line and at most 20 of
// each: moves that go more than `slack` (mm) beyond a limit somewhere, known to 1e-3 mm. `offset` as in
// CollectMoves; places are said in the program frame.
Diagnostics BrokenLimits(const ProgramMotion& motion, const CenterLimits& limits, const Vec3& offset,
                         double slack);

}  // namespace patchmill
