// Triangles for pictures and labels only. No path is planned on them.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

// A grid of cells over the parameters of a piece.
struct GridCells {
  int u = 1, v = 1;
};
// So many cells that the two triangles over each deviate by at most about `chord` mm (> 0; estimated from
// sampled second derivatives), but at most `max_cells` (>= 1) per side.
GridCells CellsWithin(const Piece& piece, double chord, int max_cells);

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
// The grid of CellsWithin for each piece. The grids of neighbouring pieces may differ, so the mesh need not
// be closed. Cost 0.1 us per vertex.
Tessellation Tessellate(const Surface& surface, double chord, int max_cells);
// The same of one piece.
Tessellation::PieceMesh TessellatePiece(const Surface& surface, PieceId piece, double chord, int max_cells);

}  // namespace patchmill
