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

// One area for each stretch of a wall beyond which nothing of the part lies: up to four ball radii deep, less
// where more of the part follows, but 1.1 at least; and the corners between two such areas. It begins where a
// ball that rolls over a sharp upper edge is half the tolerance lower than that edge. The tip stays above the
// wall's upper edge there. Of a wall whose air side looks away from the outside the area is material
// (StripKind::kMaterial), and no option lifts it. A wall of two sides (Surface::two_sided_walls) has one only
// if the part lies on its other side. Curved walls are followed by chords that stay outside of them. Outer
// border and holes are told apart on a grid of 400 cells along the longer side of the part: narrower gaps
// count as part of it. Deterministic. Cost some microseconds a stretch; nothing where nothing is upright.
absl::StatusOr<std::vector<BesideStrip>> FindBesideStrips(const Surface& surface,
                                                          const BesidePartParams& params,
                                                          const RunContext& run);

}  // namespace patchmill
