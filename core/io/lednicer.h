// Lednicer's form of airfoil co-ordinates: two runs of points, each from the nose to the tail.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/vec.h"

namespace patchmill {

// The counts of points of the upper and of the lower side, which stand before the points.
struct LednicerCounts {
  std::size_t upper = 0, lower = 0;
};

// Whether the first row of a text is the counts of the rows that follow it. They are whole numbers, two or
// more. Together they are the count of these rows, or one more where both sides share the row of the nose;
// or an empty line parts them from the points.
std::optional<LednicerCounts> CountsOf(const std::vector<Vec3>& rows, bool empty_line_after_first);

// The points in one run: from the tail along the upper side to the nose, and along the lower side to the
// tail. The nose is named twice (at the start of both sides) or once (at the start of either side), and
// stands once in the result. x grows along each side from the nose on, but for 0.5 % of the chord.
// INVALID_ARGUMENT without a line if the points do not fit the counts in exactly one of these ways.
absl::StatusOr<std::vector<Vec3>> JoinSides(const LednicerCounts& counts, const std::vector<Vec3>& points);

}  // namespace patchmill
