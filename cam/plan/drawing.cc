#include "cam/plan/drawing.h"

#include <algorithm>
#include <cmath>

#include "cam/verify/surface_cells.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kLeastChord = 1e-4;   // mm
constexpr double kSquares = 20'000.0;  // that cover the surface where a program is drawn
constexpr int kMostDoublings = 60;

// The parameters with sides, and the chord too where nobody has stated it, so large that there are few enough
// triangles. A surface of very many pieces has four triangles for each.
absl::StatusOr<MeshParams> Fitted(const Surface& surface, MeshParams params, bool chord_is_stated,
                                  const RunContext& run) {
  if (!chord_is_stated) params.most_triangles = std::max(params.most_triangles, 4 * surface.pieces.size());
  absl::Status few = CheckTriangles(surface, params, run);
  for (int k = 0; k < kMostDoublings && absl::IsResourceExhausted(few); ++k) {
    params.longest_edge *= 2.0;
    if (!chord_is_stated) params.chord *= 2.0;
    few = CheckTriangles(surface, params, run);
  }
  PM_RETURN_IF_ERROR(few);
  return params;
}

void Combine(std::vector<double>& all, const std::vector<double>& more, bool least) {
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = least ? std::min(all[i], more[i]) : std::max(all[i], more[i]);
}

absl::StatusOr<MotionAtPoints> MeasureWays(const std::vector<Vec3>& points,
                                           const std::vector<std::vector<BallMotion>>& ways,
                                           const RunContext& run) {
  std::optional<MotionAtPoints> worst;
  for (const std::vector<BallMotion>& balls : ways) {
    std::optional<MotionAtPoints> way;
    for (const BallMotion& ball : balls) {
      PM_ASSIGN_OR_RETURN(MotionAtPoints one, MeasureAt(points, ball, run));
      if (way) {
        Combine(way->leftover, one.leftover, true);
        Combine(way->gouge, one.gouge, false);
      } else {
        way = std::move(one);
      }
    }
    if (!way) continue;
    if (worst) {
      Combine(worst->leftover, way->leftover, false);
      Combine(worst->gouge, way->gouge, false);
    } else {
      worst = std::move(way);
    }
  }
  return worst ? *std::move(worst) : MotionAtPoints();
}

}  // namespace

absl::Status CheckChord(const Surface& surface, double chord, const RunContext& run) {
  MeshParams params;
  params.chord = chord;
  return CheckTriangles(surface, params, run);
}

absl::StatusOr<SurfaceDrawing> DrawSurface(const Surface& surface, const DrawingParams& params,
                                           const RunContext& run) {
  MeshParams mesh;
  if (!params.ways.empty())
    mesh.longest_edge = std::max(kLeastChord, std::sqrt(RoughArea(surface) / kSquares));
  mesh.chord = params.chord.value_or(std::max(kLeastChord, surface.box.Diagonal() / 2000.0));
  PM_ASSIGN_OR_RETURN(mesh, Fitted(surface, mesh, params.chord.has_value(), run));
  if (const RegionMap* const map = params.map; map != nullptr && map->cells > 0) {
    mesh.label_cells = map->cells;
    mesh.label = [map](PieceId piece, double u, double v) {
      return map->At({piece, u, v, Vec3::Zero()}).value;
    };
  }
  SurfaceDrawing drawing;
  drawing.chord = mesh.chord;
  PM_ASSIGN_OR_RETURN(drawing.mesh, MakeSurfaceMesh(surface, mesh, run));
  if (params.ways.empty()) return drawing;
  std::vector<Vec3> points;
  for (const PieceTriangles& piece : drawing.mesh) {
    for (const MeshVertex& vertex : piece.vertices) points.push_back(vertex.at.p);
  }
  PM_ASSIGN_OR_RETURN(drawing.motion, MeasureWays(points, params.ways, run));
  return drawing;
}

}  // namespace patchmill
