// What the motion alone tells: lengths, box, descents; and how far the tool must stick out.
#pragma once

#include "cam/tool/tool.h"
#include "cam/toolpath/toolpath.h"
#include "cam/verify/verify.h"
#include "core/surface/surface.h"

namespace patchmill {

inline constexpr double kSteepDescent = Radians(30.0);  // [verification P3]: steeper ones run at plunge feed

struct MotionFigures {
  Box3 tip_box;  // program frame, moves below machine zero; empty if there are none
  double cut_length = 0.0, rapid_length = 0.0;
  double steepest_descent = 0.0;  // rad, of feed moves longer than rounding
  // First feed move that ends a descent steeper than 30 degrees and faster than plunge feed.
  int steep_move = -1;
};
MotionFigures MeasureMotion(const ProgramMotion& motion, const Tool& tool);

// Highest material within tool or shank radius of a move minus the lowest tip of that move, largest over all
// moves. Material is taken as highest_surface + allowance, no higher than the stock, on a square grid over
// the plan: an estimate from above, by at most the height the surface gains within two grid steps.
// CANCELLED or DEADLINE_EXCEEDED when `run` says so.
absl::StatusOr<double> RequiredStickout(const Surface& surface, const Tool& tool, const ProgramMotion& motion,
                                        const VerifyParams& params, const RunContext& run);

}  // namespace patchmill
