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

// Samples one random point in each root cell; a regular grid of points could coincide with the spacing of the
// passes. On a part that is finished all over, the shares of the classes are exact to 1 %.
// params.finish.scallop must be set. `tree` is that of MeasureAreas.
absl::StatusOr<LeftoverSpread> MeasureSpread(const RootedSurface& rooted, const SegmentTree& tree,
                                             const LeftoverParams& params, const RunContext& run);

}  // namespace patchmill
