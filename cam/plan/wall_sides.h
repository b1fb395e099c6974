// Walls whose side the user picks.
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// The side of an upright wall that nothing else decides (Surface::two_sided_walls).
struct WallSide {
  std::string name;         // of patches, as SelectPatches reads it
  Vec3 air = Vec3::Zero();  // mm, placed frame: a point on the side where the tool stands
};

// Returns the surface with these sides; the named walls are no longer two-sided. For each wall the place
// nearest to `air` decides. INVALID_ARGUMENT (setup.wall_sides[k]) if nothing has the name, if none of what
// has it is a wall with two sides, or if the point lies on the wall. Cost: that of a surface of each wall.
absl::StatusOr<Surface> WithWallSides(Surface surface, const std::vector<WallSide>& sides,
                                      const RunContext& run);

}  // namespace patchmill
