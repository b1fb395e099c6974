// Joins the sides between triangles of different regions to outlines of the regions.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/border/border_arcs.h"
#include "cam/region/merge/triangle_regions.h"
#include "core/base/run_context.h"

namespace patchmill {

// Returns closed polylines on the surface: [region][loop][point], along the points of the border sides. The
// region lies on the left of its outline, as each triangle lies on the left of its sides. Where a seam is cut
// differently on its two sides, parts of an outline do not meet. They are joined to the nearest open end,
// along the surface, to `tolerance` (mm). CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<std::vector<std::vector<Vec3>>>> RegionBorders(const SplitSurface& split,
                                                                          const TriangleRegions& triangles,
                                                                          const BorderPoints& border,
                                                                          double tolerance,
                                                                          const RunContext& run);

}  // namespace patchmill
