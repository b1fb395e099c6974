#include "cam/toolpath/path_amount.h"

#include <fmt/format.h>

#include "cam/toolpath/cutter_path.h"
#include "core/base/error_details.h"

namespace patchmill {

PathAmount AmountOf(const CutterPath& path) {
  return {Length(path), static_cast<double>(path.points.size())};
}

PathAmount AmountOf(std::span<const CutterPoint> open_path) {
  return {Length(open_path), static_cast<double>(open_path.size())};
}

PathAmount AmountOf(std::span<const CutterPath> paths) {
  PathAmount sum;
  for (const CutterPath& path : paths) sum += AmountOf(path);
  return sum;
}

absl::Status CheckAmount(const PathLimits& limits, const PathAmount& amount, std::string_view when) {
  const auto passed = [&](const char* name, double limit, double value) {
    return LimitPassedError(
        {name, limit, value},
        fmt::format(
            "the passes come to more {}; a larger scallop or tolerance takes fewer, or cut the part in "
            "pieces (selection)",
            when));
  };
  if (amount.length > limits.length) return passed("cut_length_mm", limits.length, amount.length);
  if (amount.points > limits.points) return passed("point_count", limits.points, amount.points);
  return absl::OkStatus();
}

}  // namespace patchmill
