// Finds what would help in an unreachable region: how much stays there, and which tool would reach it.
#pragma once

#include <span>

#include "cam/region/reach/reach.h"
#include "cam/region/split/seams.h"
#include "core/base/run_context.h"

namespace patchmill {

// An unreachable region: why, and its triangles (at least one).
struct UnreachableRegion {
  UnreachableReason reason = UnreachableReason::kNone;
  std::span<const TriangleRef> triangles;
};

// What would help there; the figures of Region of the same names.
struct RegionProbe {
  double deepest_leftover = 0.0;       // mm
  double largest_tool_diameter = 0.0;  // mm; 0 unless the reason is CONCAVE
};

// Measures the region [regions, section 9]. The tool follows from some 200 places spread over the region and
// from others ever closer around the worst of them. Meaningless once `run` is cancelled. Different regions
// may be probed in parallel. Cost: milliseconds.
RegionProbe ProbeRegion(const SplitSurface& split, const ReachTest& reach, const RegionParams& params,
                        const UnreachableRegion& region, const RunContext& run);

}  // namespace patchmill
