// Where the fan of triangles of a cell starts that two arcs of a zero curve pass.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/lines/zero_vertices.h"

namespace patchmill {

// The sign at the start of the fan decides which vertices of `ring` (around the cell low + [0,side]^2) are
// joined. Where the centre's is one that chords to the ring's vertices of its sign do not keep - a node near
// by, whose arms cut the centre off - a place that does better; nothing where the centre will do, or nothing
// better is found. Looks at smooth fields. Cost: some hundred evaluations, only when a field changes its sign
// four times around the cell.
std::optional<Vec2> BetterMiddle(ZeroVertices& vertices, std::span<const ZeroField> fields,
                                 const std::vector<int>& ring, const Vec2& low, double side);

}  // namespace patchmill
