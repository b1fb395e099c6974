// Finds the areas beside a part that are closed to the tool: behind walls, and outside the part unless the
// job opens them.
//
// Seen from above, the surface covers an area. The plane beyond the outer border of that area is outside;
// holes are not. Where a vertical wall stands on that border, the vice, the clamps or more stock may stand
// beside it.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/limits/containment.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

struct BesidePartParams {
  double radius = 3.0;  // mm, the ball's
  double tolerance =
      0.01;  // mm: a wall that leans by less than half of it over its height counts as vertical
  bool mill_outside = false;        // walls on the outer border are milled from outside
  std::vector<bool> selected = {};  // per patch; walls that are named are milled from outside too
};

// Returns one area for each stretch of a wall beyond which no part of the surface lies, and the corners
// between two such areas. An area reaches up to four ball radii from the wall, or up to the next part of the
// surface if that is nearer, but 1.1 ball radii at least. It begins where a ball that rolls over a sharp
// upper edge is half the tolerance lower than that edge. Over the area the tip must stay above the wall's
// upper edge.
//
// An area on the material side of a wall, opposite to the air side, has StripKind::kMaterial. There may be
// one in a hole of the model, too. No option opens it. A wall with two sides (Surface::two_sided_walls) has
// an area only if the part lies on its other side. Curved walls are replaced by chords, which deviate from
// the wall by at most half of the distance at which areas begin. Outer border and holes are found on a grid
// of 400 cells along the longer side of the part; gaps narrower than a cell count as part. Walls are sampled
// every four cells. Behind a wall the surface itself is asked, too: a rib may be thinner than a cell.
//
// Deterministic. Cost: some microseconds per sample of a wall; nothing if there is no vertical piece.
// CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<BesideStrip>> FindBesideStrips(const Surface& surface,
                                                          const BesidePartParams& params,
                                                          const RunContext& run);

}  // namespace patchmill
