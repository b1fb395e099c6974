// Outlines of regions: sides between triangles of different regions, put together.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/border/border_arcs.h"
#include "core/base/run_context.h"

namespace patchmill {

// Closed polylines on the surface for every region (`region_of[piece][triangle]`, -1 none), the region on the
// left in the sense of the triangles, along the `points` of the `arcs` of the split. Pieces of outline that
// do not meet end to end (seams cut differently on their two sides) are joined to the nearest open end, along
// the surface to `tolerance` (mm). CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<std::vector<std::vector<Vec3>>>> RegionBorders(
    const Surface& surface, const AdjacencyList& adjacency, const BorderArcs& arcs,
    const BorderPoints& points, const std::vector<std::vector<int>>& region_of, std::size_t region_count,
    double tolerance, const RunContext& run);

}  // namespace patchmill
