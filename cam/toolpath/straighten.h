// Joins moves that go on straight.
#pragma once

#include "cam/toolpath/toolpath.h"

namespace patchmill {

// mm: an end of a move is left out if that changes the path by less.
inline constexpr double kStraight = 1e-4;

// Returns the same toolpath with fewer moves. The ends of feed moves with the same kind, feed, pass and
// region are left out where they lie within kStraight of the straight way on. The path changes by less than
// twice that, at any place. No end remains whose removal would change the path by less than kStraight,
// unless the ends that were left out beside it forbid that. Rapids stay. Cost O(n log n).
Toolpath Straightened(Toolpath toolpath);

}  // namespace patchmill
