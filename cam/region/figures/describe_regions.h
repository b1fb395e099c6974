// Describes regions: a point inside, their heights and patches, and the triangles of unreachable ones.
#pragma once

#include <vector>

#include "cam/region/map/region_map.h"
#include "cam/region/merge/triangle_regions.h"
#include "cam/region/split/seams.h"

namespace patchmill {

// Where a region lies.
struct RegionPlace {
  Vec3 inside = Vec3::Zero();                    // a point of it
  double z_min = kInfinity, z_max = -kInfinity;  // mm, of its surface
};

// The place of each region. The label of `map` at the point inside is the region, if the region has any
// label.
std::vector<RegionPlace> PlaceRegions(const SplitSurface& split, const TriangleRegions& triangles,
                                      const RegionMap& map);

// [region]: the triangles of each unreachable region. Lists of other regions are empty.
std::vector<std::vector<TriangleRef>> UnreachableTriangles(const TriangleRegions& triangles,
                                                           const std::vector<Region>& regions);

// [region]: the patches of the surface that it has a part of, rising.
std::vector<std::vector<PatchId>> PatchesOfRegions(const Surface& surface, const TriangleRegions& triangles);

}  // namespace patchmill
