// How much of passes there is, and how much there may be.
#pragma once

#include <span>
#include <string_view>

#include <absl/status/status.h>

#include "core/base/vec.h"

namespace patchmill {

struct CutterPath;
struct CutterPoint;

struct PathAmount {
  double length = 0.0;  // mm of chords
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

// What the passes of one plan may come to; the program's points and feed with their links too.
struct PathLimits {
  double length = kInfinity;  // mm, > 0
  double points = kInfinity;  // > 0
};

// Limits, and what counts against them before anything more is made.
struct PathBudget {
  PathLimits limits;
  PathAmount made;
};

// OK while `amount` is within the limits; else a LimitPassedError (core/base/error_details.h) of
// "cut_length_mm" or "point_count". `when` goes on the sentence: "after 40 % of the lines".
absl::Status CheckAmount(const PathLimits& limits, const PathAmount& amount, std::string_view when);

}  // namespace patchmill
