// The quadtree under a ZeroMesh: cells in which every field is settled, or that are as small as they may be.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/lines/zero_vertices.h"

namespace patchmill {

// [i, i+1] x [j, j+1] / 2^level; `node`: the id of a node in it, or on its border.
struct ZeroCell {
  int level = 0, i = 0, j = 0;
  std::optional<int> node = {};
  bool settled = true;  // the forms of all fields have a proof in it: its corners decide
};

struct ZeroCells {
  std::vector<ZeroCell> cells;
  std::vector<bool> corners;  // of gi * (kZeroGrid + 1) + gj: a corner of a cell
  std::vector<int> on_sides;  // further vertices on sides of cells
};

ZeroCells DivideForFields(const Piece& piece, std::span<const ZeroField> fields, const ZeroMeshParams& params,
                          ZeroVertices& vertices);

}  // namespace patchmill
