// What a region is like: a point of it, its heights, and what would help where no ball gets to.
#pragma once

#include <vector>

#include "cam/region/reach.h"
#include "cam/region/split_mesh.h"
#include "core/base/run_context.h"

namespace patchmill {

// Fills inside, z_min, z_max and, for unreachable regions, deepest_leftover and largest_tool_diameter (both
// estimated from spread triangles). `region_of[piece][triangle]`. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::Status DescribeRegions(const Surface& surface, const std::vector<SplitMesh>& meshes,
                             const std::vector<std::vector<int>>& region_of, const ReachTest& reach,
                             const RegionParams& params, const RunContext& run, std::vector<Region>& regions);

}  // namespace patchmill
