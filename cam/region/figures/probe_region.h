// What would help where no ball gets to: what stays there, and the tool that would reach it.
#pragma once

#include <span>
#include <vector>

#include "cam/region/reach/reach.h"
#include "cam/region/split/split_mesh.h"
#include "core/base/run_context.h"

namespace patchmill {

// Fills deepest_leftover and largest_tool_diameter of an unreachable region of these triangles, at least one
// ([regions, section 9]; the tool by some 200 places spread over them and by others closer and closer around
// the worst). Means nothing once `run` is cancelled. Regions are independent of each other. Cost:
// milliseconds.
void ProbeRegion(const Surface& surface, const std::vector<SplitMesh>& meshes, const ReachTest& reach,
                 const RegionParams& params, std::span<const TriangleRef> triangles, const RunContext& run,
                 Region& region);

}  // namespace patchmill
