// Samples what the feed moves leave, all over the surface.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cam/verify/leftover.h"

namespace patchmill {

// The leftover at the middle of a root cell.
struct LeftoverSample {
  SurfacePoint at;                 // placed frame
  std::array<Vec3, 4> corners;     // of the cell, in the order of its border
  std::optional<double> leftover;  // mm, below 0 where the ball goes deeper; absent: not reachable
};

// One sample for each root cell that is to be finished, in the order of the cells. `tree` is that of
// MeasureAreas. The values are exact at their points; larger ones may lie between them. Cost O(cells).
absl::StatusOr<std::vector<LeftoverSample>> SampleLeftover(const RootedSurface& rooted,
                                                           const SegmentTree& tree,
                                                           const LeftoverParams& params,
                                                           const RunContext& run);

}  // namespace patchmill
