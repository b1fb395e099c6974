// Where the tool may not go beside a part: behind walls, and outside the part unless the job says so.
//
// Seen from above, the surface covers an area. What lies beyond the outer border of that area is outside;
// holes are not. Where an upright wall stands on that border, the vice, the clamps or more stock may stand
// beside it.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/containment.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

struct BesidePartParams {
  double radius = 3.0;        // mm, the ball's
  double tolerance = 0.01;    // mm: a wall that leans by less than half of it over its height is upright
  bool mill_outside = false;  // walls on the outer border are milled from outside
  std::vector<bool> selected = {};  // per patch; walls that are named are milled from outside too
};

// Returns one area for each stretch of a wall beyond which nothing of the part lies, and the corners between
// two such areas. An area is up to four ball radii deep, less where more of the part follows, but 1.1 at
// least. It begins where a ball that rolls over a sharp upper edge is half the tolerance lower than that
// edge. The tip stays above the wall's upper edge there.
//
// If the air side of a wall is the other one, the area is material (StripKind::kMaterial), in a hole of the
// model too, and no option lifts it. A wall of two sides (Surface::two_sided_walls) has an area only if the
// part lies on its other side. Chords stand for curved walls. They leave the wall by at most half the
// distance at which areas begin. Outer border and holes are found on a grid of 400 cells along the longer
// side of the part: narrower gaps count as part of it. Walls are looked at every four cells.
//
// Deterministic. Cost: some microseconds per place; nothing if no piece is upright. CANCELLED and
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<BesideStrip>> FindBesideStrips(const Surface& surface,
                                                          const BesidePartParams& params,
                                                          const RunContext& run);

}  // namespace patchmill
