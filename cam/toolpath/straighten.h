// Joins moves that go on straight.
#pragma once

#include "cam/toolpath/toolpath.h"

namespace patchmill {

// mm: an end of a move is left out if that changes the path by less.
inline constexpr double kStraight = 1e-4;

// The same toolpath with fewer moves. Of feed moves with the same kind, feed, pass and region, those ends are
// left out that lie within kStraight of the straight way on. The path changes by less than twice that, at any
// place; and no end remains whose removal would change it by less than kStraight, unless the ends that were
// left out beside it forbid that. Rapids stay. Cost O(n k) for runs of k such moves, k at most 4096.
Toolpath Straightened(Toolpath toolpath);

}  // namespace patchmill
