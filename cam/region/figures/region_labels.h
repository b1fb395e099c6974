// The label grids behind RegionMap::At.
#pragma once

#include <vector>

#include "cam/region/map/region_map.h"
#include "cam/region/split/split_mesh.h"

namespace patchmill {

// Fills map.cells and map.labels from `region_of[piece][triangle]`, ids below `regions`; at most 8 million
// labels, 256 x 256 a piece. A region that holds no cell's centre gets the cell of one of its triangles from
// a neighbour that has others, so that it can be picked and switched off too; only regions crowded into
// single cells may stay without one. CANCELLED, DEADLINE_EXCEEDED from `run`.
// `component_of` fills map.components likewise, where map.component_region has more of them than `regions`;
// cells that were given away are of none.
absl::Status FillLabels(const std::vector<SplitMesh>& meshes, const std::vector<std::vector<int>>& region_of,
                        const std::vector<std::vector<int>>& component_of, std::size_t regions,
                        const RunContext& run, RegionMap& map);

}  // namespace patchmill
