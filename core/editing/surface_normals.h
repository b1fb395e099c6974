// Normals of a network from a surface that lies near it, such as its first global shape [editing, section 6].
#pragma once

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/joining/curve_network.h"
#include "core/surface/surface.h"

namespace patchmill {

struct NetworkOnSurface {
  CurveNetwork network;
  double max_distance = 0.0;  // mm, of a vertex from the surface
  int farthest_vertex = -1;   // -1: there are no vertices
};

// Every vertex without normals gets that of the surface at its nearest point (found to 1e-9 of the surface's
// size), none where the surface has none there; positions and given normals stay. Vertices that are not
// finite are left alone: joining reports them. In parallel; CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<NetworkOnSurface> WithNormalsOf(const Surface& surface, CurveNetwork network,
                                               const RunContext& run);

}  // namespace patchmill
