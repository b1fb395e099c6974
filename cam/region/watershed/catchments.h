// Finds which summit (or pit) each triangle belongs to.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/watershed/height_tops.h"
#include "core/base/run_context.h"

namespace patchmill {

// Returns for each triangle an index into `tops`, or -1 if no top is connected with the triangle. The
// triangles are flooded from the summits down, across the highest sides first (a spanning forest,
// [references: cousty2009]); for `sign` -1 from the pits up, across the lowest sides first. Sides on
// watershed lines (SplitMesh::lines) come last. So a flood crosses such a line only to triangles that it
// cannot reach otherwise: wherever the lines divide the surface they are the borders, elsewhere sides of
// triangles are. Deterministic. Cost: n log n in the worst case. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<PerTriangle<int>> Catchments(const SplitSurface& split, const std::vector<MeshVertex>& tops,
                                            double sign, const RunContext& run);

// True if the side runs along a watershed line between summits (`sign` 1), between pits (-1) or of either
// kind (0), or if the facing side across a seam does.
bool OnWatershed(const std::vector<SplitMesh>& meshes, const Adjacency& adjacency, double sign);

}  // namespace patchmill
