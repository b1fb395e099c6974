// Which summit (or pit) every triangle belongs to.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/watershed/height_tops.h"
#include "core/base/run_context.h"

namespace patchmill {

// [piece][triangle]: index into `tops`, -1 where none is connected. Ground is flooded from the tops down (for
// `sign` -1 from the pits up), over the highest sides of triangles first (a spanning forest,
// [references: cousty2009]), and over the lines of the meshes (SplitMesh::lines) that divide them
// only where nothing else leads: where lines divide the surface they are the borders, elsewhere sides of
// triangles. Deterministic; cost n log n in the worst case. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<std::vector<int>>> Catchments(const std::vector<SplitMesh>& meshes,
                                                         const AdjacencyList& adjacency,
                                                         const std::vector<MeshVertex>& tops, double sign,
                                                         const RunContext& run);

// The side of a triangle runs along a line between summits (`sign` 1), pits (-1) or either (0), or along the
// other side of a seam with one.
bool OnWatershed(const std::vector<SplitMesh>& meshes, const Adjacency& adjacency, double sign);

}  // namespace patchmill
