// What is needed to draw a job in three dimensions: the surface as triangles with the regions of its map, and
// what a program leaves at their corners.
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/map/region_map.h"
#include "cam/verify/motion_at.h"
#include "core/base/run_context.h"
#include "core/surface/surface_mesh.h"

namespace patchmill {

struct SurfaceDrawing {
  double chord = 0.0;                // mm, distance between triangles and surface
  std::vector<PieceTriangles> mesh;  // placed frame; labels are ids of regions
  // What a program leaves at the vertices, those of all pieces in a row; absent without a program.
  std::optional<MotionAtPoints> motion;
};

// mm: the chord where a request states none, a 2000th of the diagonal of the surface's box.
double DefaultChord(const Surface& surface);

// `map` null: no regions. `ball` absent: no program. Errors as MakeSurfaceMesh and MeasureAt.
absl::StatusOr<SurfaceDrawing> DrawSurface(const Surface& surface, double chord, const RegionMap* map,
                                           const std::optional<BallMotion>& ball, const RunContext& run);

}  // namespace patchmill
