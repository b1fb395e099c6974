// Curves as drawn or measured: strokes, sections, waterlines.
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "core/curve/bezier_chain.h"

namespace patchmill {

inline constexpr std::size_t kMaxDrawnCurves = 10'000;

struct DrawnCurve {
  std::string id;
  BezierChain chain;
};

// The cubic spline through points in the chord parameter. Neighbours that coincide count once.
// INVALID_ARGUMENT for fewer than two different points and for numbers that are not finite.
absl::StatusOr<BezierChain> ChainThrough(const std::vector<Vec3>& points);

}  // namespace patchmill
