// Strokes drawn by hand, from .curves: for each a line "v N", then N lines "x y z".
#pragma once

#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/vec.h"

namespace patchmill {

inline constexpr int kMaxStrokes = 10'000;
inline constexpr int kMaxStrokePoints = 1'000'000;  // of all strokes together

// One list of points for each stroke, of one point or more. '#' starts a comment. INVALID_ARGUMENT "line 12:
// reason" for anything else.
absl::StatusOr<std::vector<std::vector<Vec3>>> ReadStrokes(std::string_view text);

}  // namespace patchmill
