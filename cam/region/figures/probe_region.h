// Finds what would help in an unreachable region: how much stays there, and which tool would reach it.
#pragma once

#include <span>
#include <vector>

#include "cam/region/reach/reach.h"
#include "cam/region/split/split_mesh.h"
#include "core/base/run_context.h"

namespace patchmill {

// Fills deepest_leftover and, if the reason is CONCAVE, largest_tool_diameter of an unreachable region that
// consists of these triangles (at least one) [regions, section 9]. The tool follows from some 200 places
// spread over the region and from others ever closer around the worst of them. Meaningless once `run` is
// cancelled. Different regions may be probed in parallel. Cost: milliseconds.
void ProbeRegion(const Surface& surface, const std::vector<SplitMesh>& meshes, const ReachTest& reach,
                 const RegionParams& params, std::span<const TriangleRef> triangles, const RunContext& run,
                 Region& region);

}  // namespace patchmill
