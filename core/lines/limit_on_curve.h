// Finds where a field that is not smooth changes sign along the zero curve of another field.
#pragma once

#include <optional>

#include "core/lines/zero_field.h"

namespace patchmill {

// Starts at a place near to both. Returns the point on the zero curve of `curve` (a smooth field) where the
// sign of `limit` (a field with `limits`) changes, at most `reach` away (in parameters). The point is exact
// across the curve (1e-12) and has the resolution of `limit` along it. nullopt if there is no such point so
// near, if the curve leaves the piece, or if it cannot be followed.
std::optional<Vec2> LimitOnCurve(const ZeroField& curve, const ZeroField& limit, const Piece& piece,
                                 const Vec2& place, double reach);

}  // namespace patchmill
