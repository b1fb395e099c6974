// Measures how much area has how much leftover. It shows passes that are closer together than the scallop
// needs.
#pragma once

#include <array>

#include "cam/verify/leftover.h"

namespace patchmill {

// Reachable area by leftover, mm^2. Class k reaches from edge k - 1 to edge k of kLeftoverEdges (in
// scallops); the last class holds everything above the last edge. Places that a forced strategy cannot finish
// do not count.
using LeftoverSpread = std::array<double, kLeftoverClasses>;

// Takes one random point in each root cell, so that no grid of points coincides with a grid of passes. Shares
// are good to 1 % on a part with passes all over it. params.scallop must be set. `tree` is that of
// MeasureAreas.
absl::StatusOr<LeftoverSpread> MeasureSpread(const RootedSurface& rooted, const SegmentTree& tree,
                                             const LeftoverParams& params, const RunContext& run);

}  // namespace patchmill
