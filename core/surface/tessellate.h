// Triangles for pictures and labels only. No path is planned on them.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

struct TessellationVertex {
  Vec3 p;
  Vec3 normal;  // upward unit normal; zero where degenerate
  float u, v;
};
struct Tessellation {
  struct PieceMesh {
    PieceId piece;
    int nu = 0, nv = 0;  // grid of (nu+1)(nv+1) vertices, v fastest
    std::vector<TessellationVertex> vertices;
  };
  std::vector<PieceMesh> meshes;
};
// A uniform grid for each piece. It is so fine that its triangles deviate by at most about `chord` mm (> 0;
// estimated from sampled second derivatives), but has at most `max_cells` (>= 1) cells per side. The grids of
// neighbouring pieces may differ, so the mesh need not be closed. Cost 0.1 us per vertex.
Tessellation Tessellate(const Surface& surface, double chord, int max_cells);
// The same of one piece.
Tessellation::PieceMesh TessellatePiece(const Surface& surface, PieceId piece, double chord, int max_cells);

}  // namespace patchmill
