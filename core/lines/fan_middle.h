// Chooses where the fan of triangles of a cell starts if two arcs of a zero curve pass through the cell.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/lines/zero_vertices.h"

namespace patchmill {

// The sign at the start of the fan decides which vertices of `ring` are joined (the ring runs around the cell
// low + [0,side]^2). The centre is unfit if a chord from it to a ring vertex of its own sign meets the other
// sign. This happens near a node whose arms cut the centre off. Then a better place is returned. nullopt if
// the centre is fit or no better place is found. Uses smooth fields only. Cost: some hundred evaluations,
// only if a field changes its sign four times around the cell.
std::optional<Vec2> BetterMiddle(ZeroVertices& vertices, std::span<const ZeroField> fields,
                                 const std::vector<int>& ring, const Vec2& low, double side);

}  // namespace patchmill
