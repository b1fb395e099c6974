// Measured points of one curve, from .csv and .dat (airfoil co-ordinates).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/vec.h"

namespace patchmill {

inline constexpr int kMaxCurvePoints = 100'000;
inline constexpr std::size_t kMaxCurveTitle = 100;  // bytes of a title that are kept

struct CurvePoints {
  std::string title;  // the first line if it is no point; printable ASCII, other bytes as '?'
  std::vector<Vec3> points;
  bool planar = false;  // true if the lines had two numbers; z is then 0
};

// `format` is the file's ending without the point: "csv" (commas between the numbers) or "dat" (blanks or
// tabs). Each line holds one point of two or three numbers, the same count on all lines. Numbers are as
// TextScanner reads them. The first line may be a title instead: it does not start with a number, or does
// not have two or three words. Empty lines and lines that start with '#' are skipped. Points in Lednicer's
// form, which starts with two counts, become one run (lednicer.h); counts that do not fit the points are
// refused. Errors: INVALID_ARGUMENT "line 12: reason", or a list of the known formats.
absl::StatusOr<CurvePoints> ReadCurvePoints(std::string_view format, std::string_view text);

}  // namespace patchmill
