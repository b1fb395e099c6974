// What the reader of curve points owes whatever bytes it is given. Used by the fuzz target and by the replay
// of its seeds in tests/core/io.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/io/curve_points.h"
#include "core/network/patch_model.h"

namespace patchmill {

// Either INVALID_ARGUMENT "line N: ..." in at most 400 printable bytes, or at least one point, no more than
// the text can spell, each within the range of coordinates, and a printable title.
inline bool KeepsCurvePointsContract(std::string_view text, const absl::StatusOr<CurvePoints>& curve) {
  const auto printable = [](std::string_view s) {
    for (const char c : s) {
      if (c < 0x20 || c > 0x7e) return false;
    }
    return true;
  };
  if (!curve.ok()) {
    const std::string message(curve.status().message());
    return curve.status().code() == absl::StatusCode::kInvalidArgument && printable(message) &&
           message.substr(0, 5) == "line " && message.size() <= 400;
  }
  for (const Vec3& p : curve->points) {
    if (!(p.cwiseAbs().maxCoeff() <= kMaxCoordinate)) return false;
    if (curve->planar && p.z() != 0.0) return false;
  }
  // "0 0\n" is the shortest point.
  return !curve->points.empty() && curve->points.size() * 4 <= text.size() + 1 &&
         curve->points.size() <= static_cast<std::size_t>(kMaxCurvePoints) && printable(curve->title) &&
         curve->title.size() <= kMaxCurveTitle;
}

}  // namespace patchmill
