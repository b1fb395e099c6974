// [verification P3] for the operation's own limits: no feed outside the boundary, nothing in an obstacle.
#pragma once

#include <vector>

#include "cam/toolpath/segment_metric.h"
#include "cam/toolpath/toolpath.h"
#include "cam/verify/reach.h"

namespace patchmill {

// OBSTACLE_HIT and BESIDE_PART (all moves), OUTSIDE_BOUNDARY (feed moves) and ABOVE_TOP (feed moves, but not
// straight up or down, that touch the surface while the tip is above the highest), the deepest first, one a
// line and at most 20 of each: moves that go more than `slack` (mm) beyond a limit somewhere, known to 1e-3
// mm. `radius`, mm: of ball and stock to leave. `offset` as in CollectMoves; places are said in the program
// frame. Obstacles are kept off by rapids wherever a control may go that drives one axis before the other.
// Means nothing once `run` is cancelled.
Diagnostics BrokenLimits(const Surface& surface, const ProgramMotion& motion, const CenterLimits& limits,
                         double radius, const Vec3& offset, double slack, const RunContext& run);

// The parts of feed moves that may finish something. Behind a wall (StripKind::kMaterial) a ball finishes
// nothing: on a thin wall it would be as near to the other side. Moves are divided down to 0.01 mm.
std::vector<PathSegment> OutsideOfMaterial(const CenterLimits& limits, std::vector<PathSegment> moves);

}  // namespace patchmill
