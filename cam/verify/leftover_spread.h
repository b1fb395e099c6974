// How much area has how much left: passes that lie closer together than the scallop asks for show here.
#pragma once

#include <vector>

#include "cam/verify/leftover.h"

namespace patchmill {

// Reachable area by leftover in scallops, in the classes of kLeftoverClasses: from the edge before to its
// own, the last one everything above; mm^2. What a forced strategy cannot finish does not count.
using LeftoverSpread = std::array<double, kLeftoverClasses>;

// By one point in each root cell, drawn anew in each, so that no grid of points meets a grid of passes:
// shares of a part with passes all over it are good to 1 %. params.scallop must be there; `tree` as for
// MeasureAreas.
absl::StatusOr<LeftoverSpread> MeasureSpread(const Surface& surface, const std::vector<CellRect>& roots,
                                             const SegmentTree& tree, const LeftoverParams& params,
                                             const RunContext& run);

}  // namespace patchmill
