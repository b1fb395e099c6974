// Cuts a triangle in rational Bernstein form into three rectangles around its centroid. Private to
// core/patch.
#pragma once

#include <vector>

#include "core/patch/piece.h"

namespace patchmill::internal {

// `points`: homogeneous, in the layout of BezierTriangle, degree 1..kMaxDegree. A point with w = 0 has all
// coordinates 0. The pieces have no patch id. Cost O(degree^6).
std::vector<Piece> TrianglePieces(int degree, const std::vector<Vec4>& points, bool rational);

}  // namespace patchmill::internal
