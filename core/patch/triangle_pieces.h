// A triangle in rational Bernstein form as three rectangles around its centroid. Private to core/patch.
#pragma once

#include <vector>

#include "core/patch/piece.h"

namespace patchmill::internal {

// `points`: homogeneous, laid out as BezierTriangle, degree 1..kMaxDegree; a point without weight is zero
// altogether. Without patch id. Cost O(degree^6).
std::vector<Piece> TrianglePieces(int degree, const std::vector<Vec4>& points, bool rational);

}  // namespace patchmill::internal
