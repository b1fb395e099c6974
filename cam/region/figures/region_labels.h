// Makes the grids of labels behind RegionMap::At and RegionMap::ComponentAt.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/merge/triangle_regions.h"
#include "core/base/run_context.h"

namespace patchmill {

// The fields of RegionMap of the same names.
struct RegionLabels {
  int cells = 0;
  std::vector<std::vector<RegionId>> labels;
  std::vector<std::vector<ComponentId>> components;
};

// Labels each cell with the region at its centre. There are at most 8 million labels in all, and at most 256
// x 256 for a piece. A small region may contain no centre of a cell. It then gets a cell that one of its
// triangles meets, if the region of that cell has other cells, so that it can be picked and switched off,
// too. If several small regions meet the same cell, some may stay without one.
//
// The components of the cells follow in the same way if there are more components than regions. A cell that a
// region took counts for the first component of that region. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<RegionLabels> LabelCells(const std::vector<SplitMesh>& meshes,
                                        const TriangleRegions& triangles, const RunContext& run);

}  // namespace patchmill
