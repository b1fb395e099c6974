// Checks a program against the limits of the operation [verification P3]: no feed leaves the boundary, and
// nothing enters an obstacle.
#pragma once

#include <vector>

#include "cam/toolpath/segment_metric.h"
#include "cam/toolpath/toolpath.h"
#include "cam/verify/reach.h"

namespace patchmill {

// The limits that a program is checked against.
struct LimitCheck {
  const CenterLimits& limits;
  double radius = 0.0;         // mm, of the ball plus the stock to leave
  Vec3 offset = Vec3::Zero();  // that of CollectMoves; messages give places in the program frame
  double slack = 0.0;          // mm; moves may go so far beyond a limit
};

// Reports moves that go more than check.slack beyond a limit, to 1e-3 mm:
// - OBSTACLE_HIT: all moves, and for rapids all places to which a control may go that drives one axis before
//   the other;
// - HOLDER_HIT: the same for the holder;
// - BESIDE_PART: all moves;
// - OUTSIDE_BOUNDARY: feed moves;
// - ABOVE_TOP: feed moves that touch the surface while the tip is above the highest one allowed. Moves
//   straight up or down do not count.
// Of each code at most 20 findings are reported, one for each program line, the deepest first. The
// result is meaningless once `run` is cancelled.
Diagnostics BrokenLimits(const Surface& surface, const ProgramMotion& motion, const LimitCheck& check,
                         const RunContext& run);

// Returns the parts of feed moves that count as cutting: those outside of the areas behind walls
// (StripKind::kMaterial). Otherwise, on a thin wall, a move behind the wall would count as finishing the
// other side. Moves are divided down to 0.01 mm.
std::vector<PathSegment> OutsideOfMaterial(const CenterLimits& limits, std::vector<PathSegment> moves);

}  // namespace patchmill
