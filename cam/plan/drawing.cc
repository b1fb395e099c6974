#include "cam/plan/drawing.h"

#include <algorithm>

#include "core/base/status.h"

namespace patchmill {

double DefaultChord(const Surface& surface) {
  constexpr double kLeast = 1e-4;  // mm
  return std::max(kLeast, surface.box.Diagonal() / 2000.0);
}

absl::StatusOr<SurfaceDrawing> DrawSurface(const Surface& surface, double chord, const RegionMap* map,
                                           const std::optional<BallMotion>& ball, const RunContext& run) {
  MeshParams params;
  params.chord = chord;
  if (map != nullptr && map->cells > 0) {
    params.label_cells = map->cells;
    params.label = [map](PieceId piece, double u, double v) {
      return map->At({piece, u, v, Vec3::Zero()}).value;
    };
  }
  SurfaceDrawing drawing;
  drawing.chord = chord;
  PM_ASSIGN_OR_RETURN(drawing.mesh, MakeSurfaceMesh(surface, params, run));
  if (!ball) return drawing;
  std::vector<Vec3> points;
  for (const PieceTriangles& piece : drawing.mesh) {
    for (const MeshVertex& vertex : piece.vertices) points.push_back(vertex.at.p);
  }
  PM_ASSIGN_OR_RETURN(drawing.motion, MeasureAt(points, *ball, run));
  return drawing;
}

}  // namespace patchmill
