// A part of the surface, by equal cells of its pieces' parameters: what chosen regions come to for those who
// know nothing of regions. Like Containment a definition that planner and judge share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/typed_id.h"

namespace patchmill {

class SurfaceMask {
 public:
  // marked[piece][i * cells + j]: the cell [i, i + 1) x [j, j + 1) / cells of (u,v) is in it; cells >= 1. An
  // empty list: nothing of the piece.
  SurfaceMask(int cells, const std::vector<std::vector<bool>>& marked);

  int cells() const { return cells_; }
  std::size_t pieces() const { return below_.size(); }
  bool Has(PieceId piece, double u, double v) const;
  // Some cell of the rectangle is in it; cells that only touch it do not count. Cost O(1).
  bool HasAny(PieceId piece, double u0, double u1, double v0, double v1) const;
  bool HasCell(PieceId piece, int i, int j) const { return Count(piece, i, i + 1, j, j + 1) > 0; }

 private:
  // Marked cells of [i0, i1) x [j0, j1).
  std::int32_t Count(PieceId piece, int i0, int i1, int j0, int j1) const;

  int cells_;
  // Of a piece with cells of both kinds: marked cells below (i, j), (cells + 1)^2 of them. Else a 1 where all
  // are, nothing where none is.
  std::vector<std::vector<std::int32_t>> below_;
};

}  // namespace patchmill
