// Describes regions: a point inside, their heights, and the triangles of unreachable ones.
#pragma once

#include <vector>

#include "cam/region/map/region_map.h"
#include "cam/region/split/split_mesh.h"

namespace patchmill {

// Fills inside, z_min and z_max of all regions. region_of[piece][triangle] is a region. The label of `map` at
// the point inside is the region, if the region has any label.
void PlaceRegions(const Surface& surface, const std::vector<SplitMesh>& meshes,
                  const std::vector<std::vector<RegionId>>& region_of, const RegionMap& map,
                  std::vector<Region>& regions);

// [region]: the triangles of each unreachable region. Lists of other regions are empty.
std::vector<std::vector<TriangleRef>> UnreachableTriangles(
    const std::vector<SplitMesh>& meshes, const std::vector<std::vector<RegionId>>& region_of,
    const std::vector<Region>& regions);

}  // namespace patchmill
