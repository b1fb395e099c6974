// The quadtree under a ZeroMesh. In its cells every field is settled, or the cells are as small as allowed.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/lines/zero_vertices.h"

namespace patchmill {

// The cell [i, i+1] x [j, j+1] / 2^level. `node` is the id of a node in it or on its border.
struct ZeroCell {
  int level = 0, i = 0, j = 0;
  std::optional<int> node = {};
  bool settled = true;  // the forms of all fields are proven in it: its corners decide
};

struct ZeroCells {
  std::vector<ZeroCell> cells;
  std::vector<bool> corners;  // index gi * (kZeroGrid + 1) + gj; true if it is a corner of a cell
  std::vector<int> on_sides;  // further vertices on sides of cells
};

ZeroCells DivideForFields(const Piece& piece, std::span<const ZeroField> fields, const ZeroMeshParams& params,
                          ZeroVertices& vertices);

}  // namespace patchmill
