// Normals of a network from a surface near it, such as its first global shape [editing, section 6].
#pragma once

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/joining/curve_network.h"
#include "core/surface/surface.h"

namespace patchmill {

struct NetworkOnSurface {
  CurveNetwork network;
  double max_distance = 0.0;  // mm, largest distance of a vertex from the surface
  int farthest_vertex = -1;   // -1 if there are no vertices
};

// Every vertex without normals gets the normal of the surface at its nearest point, which is found to 1e-9 of
// the surface's size. It gets none where the surface has none. Positions and given normals stay. Vertices
// that are not finite are left alone: joining reports them. Vertices on edges are left alone, too. Runs in
// parallel. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<NetworkOnSurface> WithNormalsOf(const Surface& surface, CurveNetwork network,
                                               const RunContext& run);

}  // namespace patchmill
