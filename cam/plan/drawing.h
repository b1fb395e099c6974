// The data of a three-dimensional drawing of a job: the surface as triangles with the regions of its map, and
// the leftover and the gouge of a program at their corners.
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/map/region_map.h"
#include "cam/verify/motion_at.h"
#include "core/base/run_context.h"
#include "core/surface/surface_mesh.h"

namespace patchmill {

struct DrawingParams {
  // mm, > 0: distance between triangles and surface. Absent: a 2000th of the diagonal of the surface's box,
  // or twice that and so on until there are few enough triangles.
  std::optional<double> chord;
  const RegionMap* map = nullptr;  // null: no regions
  // The program, in every way it may run, each as the motions of its balls. Empty: no program.
  std::vector<std::vector<BallMotion>> ways;
};

struct SurfaceDrawing {
  double chord = 0.0;                // mm
  std::vector<PieceTriangles> mesh;  // placed frame; labels are ids of regions
  // Leftover and gouge at the vertices, those of all pieces in a row. Of several tools, the least leftover
  // and the deepest gouge count; of several ways, the largest of each. Absent without a program.
  std::optional<MotionAtPoints> motion;
};

// OK if there are few enough triangles for this chord (CheckTriangles).
absl::Status CheckChord(const Surface& surface, double chord, const RunContext& run);

// With a program, cells are at most as wide as the side of one of 20,000 squares that cover the surface, so
// that flat areas have vertices too; wider where that would make too many triangles. Errors as MeasureAt, and
// as CheckChord where a chord is stated.
absl::StatusOr<SurfaceDrawing> DrawSurface(const Surface& surface, const DrawingParams& params,
                                           const RunContext& run);

}  // namespace patchmill
