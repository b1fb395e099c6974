// Fills the label grids behind RegionMap::At and RegionMap::ComponentAt.
#pragma once

#include <vector>

#include "cam/region/map/region_map.h"
#include "cam/region/split/split_mesh.h"

namespace patchmill {

// Fills map.cells and map.labels from region_of[piece][triangle], which holds ids below `regions`. There are
// at most 8 million labels, and at most 256 x 256 for a piece. A region that contains no cell's centre takes
// the cell of one of its triangles from a region that has others, so that it can be picked and switched off,
// too. Regions that share single cells may stay without one.
//
// Fills map.components in the same way from `component_of` if map.component_region has more components than
// there are `regions`. A cell that a region took counts for the first component of that region. CANCELLED and
// DEADLINE_EXCEEDED from `run`.
absl::Status FillLabels(const std::vector<SplitMesh>& meshes,
                        const std::vector<std::vector<RegionId>>& region_of,
                        const std::vector<std::vector<ComponentId>>& component_of, std::size_t regions,
                        const RunContext& run, RegionMap& map);

}  // namespace patchmill
