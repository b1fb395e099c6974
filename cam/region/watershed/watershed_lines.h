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
  double tolerance =
      0.01;  // mm: sagitta of chords on the true lines; a vertex this near to a line becomes part of it
  double spacing = 3.0;               // mm, about twice the longest chord
  double steep_angle = 0.0;           // rad, for the steepness of the triangles that are cut
  std::span<const ZeroField> fields;  // fields of the meshes
};

struct WatershedPasses {
  // Passes between summits, from which lines run down, and passes between pits, from which lines run up.
  std::vector<MeshVertex> summits, pits;
};

// From each pass lines start to both sides: at the saddle point of the surface next to the pass, or at the
// pass itself if there is none. From a pass between summits they run down to a pit, from a pass between pits
// up to a summit. A line ends earlier at the border of the surface and at another line of its kind. Where the
// surface has no direction of steepest slope, as along creases, a line follows the steepest sides of
// triangles. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<SplitSurface> CutWatersheds(SplitSurface split, const WatershedPasses& passes,
                                           const WatershedParams& params, const RunContext& run);

}  // namespace patchmill
