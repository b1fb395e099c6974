// What a region is like: a point of it and its heights; which triangles no ball gets to.
#pragma once

#include <vector>

#include "cam/region/map/region_map.h"
#include "cam/region/split/split_mesh.h"

namespace patchmill {

// Fills inside, z_min and z_max of all regions. `region_of[piece][triangle]`. A point inside is one by which
// the region is found among the labels of `map`, where it has any.
void PlaceRegions(const Surface& surface, const std::vector<SplitMesh>& meshes,
                  const std::vector<std::vector<int>>& region_of, const RegionMap& map,
                  std::vector<Region>& regions);

// The triangles of each unreachable region; none of others.
std::vector<std::vector<TriangleRef>> UnreachableTriangles(const std::vector<SplitMesh>& meshes,
                                                           const std::vector<std::vector<int>>& region_of,
                                                           const std::vector<Region>& regions);

}  // namespace patchmill
