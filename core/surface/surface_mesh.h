// The surface as indexed triangles with labels, to be drawn. No path is planned on them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

struct MeshVertex {
  SurfacePoint at;
  // Unit, to the side from which the tool comes; at a pole that of the surface beside it; zero where that is
  // degenerate, too. On the rim of a sheet, where the
  // surface becomes vertical and either side may count, it is that of the surface beside the rim.
  Vec3 normal = Vec3::Zero();
  double slope = 0.0;              // rad, between the normal and +Z, [0, pi]
  double contour_curvature = 0.0;  // 1/mm, > 0 where contours bend inward; 0 where the surface is level
};

struct MeshTriangle {
  std::array<std::uint32_t, 3> vertices;  // of the same piece
  int label = -1;
};

// The triangles of one piece.
struct PieceTriangles {
  PieceId piece;
  std::vector<MeshVertex> vertices;
  std::vector<MeshTriangle> triangles;
};

struct MeshParams {
  double chord = 0.01;  // mm, > 0: distance between triangles and surface, estimated (CellsWithin)
  double longest_edge = kInfinity;         // mm, > 0: of the sides of cells, estimated
  std::size_t most_triangles = 1'000'000;  // of the whole surface
  // The label at a place of a piece's parameters. It is constant in each cell of a grid of `label_cells` x
  // `label_cells` over the piece. If empty, all labels are -1.
  std::function<int(PieceId, double u, double v)> label = nullptr;
  int label_cells = 1;  // >= 1
};

// The triangles of each piece, in order. Cells in which the label changes are divided along both axes, down
// to the grid of labels or a 32nd of a cell, and so are their sides on the border of a piece. If that makes
// more than `most_triangles`, nothing is divided. The triangles of a piece leave no gaps; those of
// neighbouring pieces may, by about a 16th of the chord, or by the chord where nothing is divided.
// RESOURCE_EXHAUSTED ("triangles") as CheckTriangles; CANCELLED and DEADLINE_EXCEEDED from `run`. Cost about
// 1 us per vertex.
absl::StatusOr<std::vector<PieceTriangles>> MakeSurfaceMesh(const Surface& surface, const MeshParams& params,
                                                            const RunContext& run);

// OK if the triangles are at most `most_triangles` without any division. Cost some microseconds per piece.
absl::Status CheckTriangles(const Surface& surface, const MeshParams& params, const RunContext& run);

}  // namespace patchmill
