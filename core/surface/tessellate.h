// Triangles for pictures and labels only; no path is planned on them.
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
// Uniform grid per piece, fine enough that chords deviate by at most about `chord` mm (estimated from second
// derivatives), at most `max_cells` a side.
Tessellation Tessellate(const Surface& surface, double chord, int max_cells);

}  // namespace patchmill
