// The amount of passes: how much there is, and how much is allowed.
#pragma once

#include <span>
#include <string_view>

#include <absl/status/status.h>

#include "core/base/vec.h"

namespace patchmill {

struct CutterPath;
struct CutterPoint;

struct PathAmount {
  double length = 0.0;  // mm, total length of the chords
  double points = 0.0;

  PathAmount& operator+=(const PathAmount& more) {
    length += more.length;
    points += more.points;
    return *this;
  }
};

PathAmount AmountOf(const CutterPath& path);
PathAmount AmountOf(std::span<const CutterPoint> open_path);
PathAmount AmountOf(std::span<const CutterPath> paths);

// Limits for the passes of one plan, and for the points and the feed length of the program with its links.
struct PathLimits {
  double length = kInfinity;  // mm, > 0
  double points = kInfinity;  // > 0
};

// Limits, and the amount that counts against them from the start.
struct PathBudget {
  PathLimits limits;
  PathAmount made;
};

// OK while `amount` is within the limits. Otherwise a LimitPassedError (core/base/error_details.h) of
// "cut_length_mm" or "point_count". The sentence ends with `when`, for example "after 40 % of the lines".
absl::Status CheckAmount(const PathLimits& limits, const PathAmount& amount, std::string_view when);

}  // namespace patchmill
