// Finds which summit (or pit) each triangle belongs to.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/watershed/height_tops.h"
#include "core/base/run_context.h"

namespace patchmill {

// Returns for each triangle an index into `tops`, or -1 if no top is connected with the triangle. The surface
// is flooded from the summits down (for `sign` -1 from the pits up), over the highest sides of triangles
// first (a spanning forest, [references: cousty2009]). It is flooded across the watershed lines of the meshes
// (SplitMesh::lines) last, where nothing else leads. So these lines are the borders where they divide the
// surface; elsewhere sides of triangles are. Deterministic. Cost: n log n in the worst case. CANCELLED and
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<PerTriangle<int>> Catchments(const SplitSurface& split, const std::vector<MeshVertex>& tops,
                                            double sign, const RunContext& run);

// True if the side runs along a watershed line between summits (`sign` 1), between pits (-1) or of either
// kind (0), or if the facing side across a seam does.
bool OnWatershed(const std::vector<SplitMesh>& meshes, const Adjacency& adjacency, double sign);

}  // namespace patchmill
