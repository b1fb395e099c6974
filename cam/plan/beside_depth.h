// The deepest place of the tool beside a part. A machinist must know it before the vice is closed.
#pragma once

#include <optional>

#include <absl/status/statusor.h>

#include "cam/toolpath/toolpath.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

struct BesideDepth {
  Vec3 tip = Vec3::Zero();  // mm, placed frame: the lowest tip beside the part at the end of a move
  double below_top = 0.0;   // mm: how far that is below the highest point of the part
};

// Returns the lowest tip beside the part at the end of a move. Here the tool is beside the part if its axis
// is at least a tenth of the ball's radius outside of the area that the surface covers as seen from above;
// holes count, too. nullopt if no such tip is lower than the part's top by more than half the ball's radius,
// as a ball that rolls over a low border is not. `top_z` (mm) is the top of the part. Cost: some
// microseconds for each end of a move that is lower than the answer.
absl::StatusOr<std::optional<BesideDepth>> DeepestBeside(const Surface& surface, const Toolpath& toolpath,
                                                         double top_z, const RunContext& run);

}  // namespace patchmill
