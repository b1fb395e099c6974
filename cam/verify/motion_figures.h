// Measures a program's motion: lengths, box and descents, and the stick-out that the tool needs.
#pragma once

#include <vector>

#include "cam/tool/tool.h"
#include "cam/toolpath/toolpath.h"
#include "cam/verify/verify.h"
#include "core/surface/surface.h"

namespace patchmill {

// Steeper descents must run at plunge feed [verification P3].
inline constexpr double kSteepDescent = Radians(30.0);

struct MotionFigures {
  Box3 tip_box;  // program frame; places of the tip below machine zero; empty if there are none
  double cut_length = 0.0, rapid_length = 0.0;  // mm, of moves that do not touch machine zero
  int feed_blocks = 0, arc_blocks = 0;          // lines with such feed moves, and the arcs among them
  double steepest_descent = 0.0;                // rad, of feed moves longer than rounding
  // The feed moves of descents that are steeper than 30 degrees and faster than plunge feed, in rising order.
  std::vector<int> steep_moves;
};
MotionFigures MeasureMotion(const ProgramMotion& motion, const Tool& tool);

// Returns the stick-out (mm, from the tip to the holder) that the tool needs. For each move it is the height
// of the highest material above the lowest tip of the move, within the radius of tool or shank in plan; the
// result is the largest over all moves. The material reaches up to the surface plus the stock allowance, but
// no higher than the top of the stock or the highest point of the surface, whichever is higher. Heights of
// the material come from a grid of squares in plan, so the result is an upper bound. It exceeds the true
// value by no more than the surface rises within two grid steps. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<double> RequiredStickout(const Surface& surface, const Tool& tool, const ProgramMotion& motion,
                                        const VerifyParams& params, const RunContext& run);

}  // namespace patchmill
