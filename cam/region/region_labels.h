// The label grids behind RegionMap::At.
#pragma once

#include <vector>

#include "cam/region/region_map.h"
#include "cam/region/split_mesh.h"

namespace patchmill {

// Fills map.cells and map.labels from `region_of[piece][triangle]`; at most 8 million labels, 256 x 256 a
// piece. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::Status FillLabels(const std::vector<SplitMesh>& meshes, const std::vector<std::vector<int>>& region_of,
                        const RunContext& run, RegionMap& map);

}  // namespace patchmill
