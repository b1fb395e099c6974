// A part of the surface, as equal cells of the parameters of its pieces. It represents chosen regions for
// code that knows nothing of regions. Like Containment, planner and verifier share this definition.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/typed_id.h"

namespace patchmill {

class SurfaceMask {
 public:
  // marked[piece][i * cells + j] says whether the cell [i, i + 1) x [j, j + 1) / cells of (u,v) belongs to
  // the mask; cells >= 1. An empty list means nothing of the piece.
  SurfaceMask(int cells, const std::vector<std::vector<bool>>& marked);

  int cells() const { return cells_; }
  std::size_t pieces() const { return below_.size(); }
  bool Has(PieceId piece, double u, double v) const;
  // True if some cell of the rectangle belongs to the mask. Cells that only touch the rectangle do not count.
  // Cost O(1).
  bool HasAny(PieceId piece, double u0, double u1, double v0, double v1) const;
  bool HasCell(PieceId piece, int i, int j) const { return Count(piece, i, i + 1, j, j + 1) > 0; }

 private:
  // The number of marked cells of [i0, i1) x [j0, j1).
  std::int32_t Count(PieceId piece, int i0, int i1, int j0, int j1) const;

  int cells_;
  // Index: piece. For a piece with both kinds of cells: the numbers of marked cells below (i, j); there are
  // (cells + 1)^2 of them. Otherwise a single 1 if all cells are marked, and an empty list if none is.
  std::vector<std::vector<std::int32_t>> below_;
};

}  // namespace patchmill
