// The deepest place of the tool beside a part. A machinist must know it before the vice is closed.
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/toolpath/toolpath.h"
#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

struct BesideDepth {
  Vec3 tip = Vec3::Zero();  // mm, placed frame: the lowest tip beside the part at the end of a move
  double below_top = 0.0;   // mm: how far that is below the highest point of the part
};

// The ends of moves below machine zero, as tips in the placed frame.
std::vector<Vec3> TipsOf(const Toolpath& toolpath);
std::vector<Vec3> TipsOf(const ProgramMotion& motion, const Vec3& program_zero);

// Returns the lowest of these tips that is beside the part. Here the tool is beside the part if its axis is
// at least a tenth of the ball's radius outside of the area that the surface covers as seen from above;
// holes count, too. nullopt if no such tip is lower than the part's top by more than half the ball's radius,
// as a ball that rolls over a low border is not. Cost: some microseconds for each tip that is lower than the
// answer.
absl::StatusOr<std::optional<BesideDepth>> DeepestBeside(const Surface& surface, std::vector<Vec3> tips,
                                                         double radius, const RunContext& run);

// The finding about it: TOOL_BESIDE_PART with the place; none if the tool is nowhere beside the part.
absl::StatusOr<Diagnostics> FindToolBesidePart(const Surface& surface, std::vector<Vec3> tips, double radius,
                                               const Vec3& program_zero, const RunContext& run);

}  // namespace patchmill
