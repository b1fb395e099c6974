// Where a field that is not smooth changes sign along another one's zero curve.
#pragma once

#include <optional>

#include "core/lines/zero_field.h"

namespace patchmill {

// From a place near to both: on the zero curve of `curve`, which is smooth, where the sign of `limit`
// changes, which has `limits`; no farther away than `reach` (in parameters). Exact for the curve (1e-12),
// along it to the resolution of `limit`. Nothing where there is none so near, or the curve leaves the piece
// or cannot be followed.
std::optional<Vec2> LimitOnCurve(const ZeroField& curve, const ZeroField& limit, const Piece& piece,
                                 const Vec2& place, double reach);

}  // namespace patchmill
