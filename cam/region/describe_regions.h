// What a region is like: a point of it, its heights, and what would help where no ball gets to.
#pragma once

#include <vector>

#include "cam/region/reach.h"
#include "cam/region/split_mesh.h"
#include "core/base/run_context.h"

namespace patchmill {

// Fills inside, z_min and z_max of all regions. `region_of[piece][triangle]`. A point inside is one by which
// the region is found among the labels of `map`, where it has any.
void PlaceRegions(const Surface& surface, const std::vector<SplitMesh>& meshes,
                  const std::vector<std::vector<int>>& region_of, const RegionMap& map,
                  std::vector<Region>& regions);

struct TriangleRef {
  std::size_t piece = 0, triangle = 0;
};

// The triangles of each unreachable region; none of others.
std::vector<std::vector<TriangleRef>> UnreachableTriangles(const std::vector<SplitMesh>& meshes,
                                                           const std::vector<std::vector<int>>& region_of,
                                                           const std::vector<Region>& regions);

// Fills deepest_leftover and largest_tool_diameter of an unreachable region of these triangles (both
// estimated from some spread over them). Means nothing once `run` is cancelled. One region's after the
// other's take time: regions are independent of each other.
void ProbeRegion(const Surface& surface, const std::vector<SplitMesh>& meshes, const ReachTest& reach,
                 const RegionParams& params, const std::vector<TriangleRef>& triangles, const RunContext& run,
                 Region& region);

}  // namespace patchmill
