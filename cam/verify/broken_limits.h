// Checks a program against the limits of the operation [verification P3]: no feed leaves the boundary, and
// nothing enters an obstacle.
#pragma once

#include <vector>

#include "cam/toolpath/segment_metric.h"
#include "cam/toolpath/toolpath.h"
#include "cam/verify/reach.h"

namespace patchmill {

// Reports moves that go more than `slack` (mm) beyond a limit, to 1e-3 mm:
// - OBSTACLE_HIT: all moves, and for rapids all places to which a control may go that drives one axis before
//   the other;
// - BESIDE_PART: all moves;
// - OUTSIDE_BOUNDARY: feed moves;
// - ABOVE_TOP: feed moves that touch the surface while the tip is above the highest one allowed. Moves
//   straight up or down do not count.
// Of each code at most 20 findings are reported, one for each program line, the deepest first. `radius` is
// that of the ball plus the stock to leave, mm. `offset` is that of CollectMoves; messages give places in the
// program frame. Meaningless once `run` is cancelled.
Diagnostics BrokenLimits(const Surface& surface, const ProgramMotion& motion, const CenterLimits& limits,
                         double radius, const Vec3& offset, double slack, const RunContext& run);

// The parts of feed moves that count as cutting. A ball on the back of a wall (StripKind::kMaterial) finishes
// nothing: on a thin wall it would be as near to the other side. Moves are divided down to 0.01 mm.
std::vector<PathSegment> OutsideOfMaterial(const CenterLimits& limits, std::vector<PathSegment> moves);

}  // namespace patchmill
