// The lines of steepest slope from the passes between summits (or pits) that stand out, cut into the meshes:
// what divides one mountain from the next.
#pragma once

#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/watershed/height_tops.h"
#include "core/base/run_context.h"

namespace patchmill {

struct WatershedParams {
  double tolerance = 0.01;   // mm, of chords on the true lines, and of how near vertices become part of them
  double spacing = 3.0;      // mm: twice the longest chord, about
  double steep_angle = 0.0;  // rad, of the measures of cut triangles
  std::span<const ZeroField> fields;  // of the meshes
};

struct WatershedPasses {
  std::vector<MeshVertex> summits, pits;  // between summits, from where lines run down; between pits: up
};

// From the saddle of the surface next to each pass, else from the pass itself, to both sides. A line ends at
// the border of the surface, at another line of its kind, or in a pit (on a summit); where the flow has no
// direction, as along creases, it follows the steepest sides of triangles. The adjacency no longer holds
// where meshes were cut; returns whether any was. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<bool> CutWatersheds(const Surface& surface, const WatershedPasses& passes,
                                   const WatershedParams& params, const RunContext& run,
                                   std::vector<SplitMesh>& meshes);

}  // namespace patchmill
