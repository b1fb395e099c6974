// Measured points of one curve, from .csv and .dat (airfoil co-ordinates).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/vec.h"

namespace patchmill {

inline constexpr int kMaxCurvePoints = 100'000;
inline constexpr std::size_t kMaxCurveTitle = 100;  // bytes kept of a title

struct CurvePoints {
  std::string title;  // the first line when it is no point; printable ASCII, other bytes as '?'
  std::vector<Vec3> points;
  bool planar = false;  // the lines had two numbers; z is 0
};

// `format` is the file's ending without the point: "csv" (numbers parted by commas) or "dat" (by blanks or
// tabs). One point a line, two or three numbers, on all lines the same; numbers as TextScanner reads them.
// The first line may be a title instead: it does not start with a number, or has not two or three words.
// Empty lines and lines that start with '#' are skipped. The counts of Lednicer's form of .dat are refused,
// not taken for a point. Errors: INVALID_ARGUMENT "line 12: reason", or the formats known.
absl::StatusOr<CurvePoints> ReadCurvePoints(std::string_view format, std::string_view text);

}  // namespace patchmill
