// Measures leftover and gouge of a motion at given points [verification, section 4].
#pragma once

#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/toolpath/toolpath.h"
#include "core/base/run_context.h"
#include "core/base/vec.h"

namespace patchmill {

struct BallMotion {
  const ProgramMotion* motion = nullptr;  // required
  Vec3 program_zero = Vec3::Zero();       // mm, in the frame of the points
  double ball_radius = 3.0;               // mm
  double leave = 0.0;                     // mm, stock to leave
};

// Two values for each point, mm. `leftover`: its distance from the nearest feed of the ball's centre, less
// R, which is the ball's radius plus the stock to leave; the diagonal of the motion and the points where
// nothing is fed. `gouge`: R less its distance from all moves below machine zero, swept upward; at least 0.
struct MotionAtPoints {
  std::vector<double> leftover, gouge;
};

// Exact at each point but for the chords of arcs. CANCELLED and DEADLINE_EXCEEDED from `run`. Cost: some
// microseconds for each point, and the trees of the moves.
absl::StatusOr<MotionAtPoints> MeasureAt(std::span<const Vec3> points, const BallMotion& ball,
                                         const RunContext& run);

}  // namespace patchmill
