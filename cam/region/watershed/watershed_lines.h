// Cuts the lines of steepest slope from the passes between persisting summits (or pits) into the meshes. They
// divide one mountain (or basin) from the next.
#pragma once

#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/watershed/height_tops.h"
#include "core/base/run_context.h"

namespace patchmill {

struct WatershedParams {
  double tolerance = 0.01;   // mm, sagitta of chords on the true lines; vertices this near become part of one
  double spacing = 3.0;      // mm, about twice the longest chord
  double steep_angle = 0.0;  // rad, for the steepness of the triangles that are cut
  std::span<const ZeroField> fields;  // fields of the meshes
};

struct WatershedPasses {
  // Passes between summits, from which lines run down, and passes between pits, from which lines run up.
  std::vector<MeshVertex> summits, pits;
};

// Lines leave the saddle of the surface next to each pass, or the pass itself if there is no saddle, to both
// sides. A line ends at the border of the surface, at another line of its kind, or in a pit (on a summit).
// Where the flow has no direction, as along creases, it follows the steepest sides of triangles. CANCELLED
// and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<SplitSurface> CutWatersheds(SplitSurface split, const WatershedPasses& passes,
                                           const WatershedParams& params, const RunContext& run);

}  // namespace patchmill
