// What tracing contours could not decide, told once for all levels.
#pragma once

#include <optional>

#include "cam/path/contour/contour_paths.h"
#include "core/base/diagnostic.h"

namespace patchmill {

// Takes levels in order, and keeps nothing of them but counts, heights and the worst.
class ContourFindings {
 public:
  explicit ContourFindings(double resolution) : resolution_(resolution) {}  // mm, asked for

  void Take(const LevelContours& level);

  // At most one of each, told at a place of the worst level: CONTOUR_COARSE (warning) with the resolution
  // held in place of the one asked for, CONTOUR_AMBIGUOUS (info) with how many cells were left undecided, and
  // their size.
  Diagnostics Findings() const;

 private:
  struct Levels {
    int count = 0;
    double lowest = 0.0, highest = 0.0;  // mm, height of the centre
    double cell = 0.0;                   // mm, the largest
    std::optional<Vec3> where;           // on the first level with cells that large
  };
  static void Take(const LevelContours& level, Levels* of);

  double resolution_;
  Levels coarse_, ambiguous_;
  long long undecided_ = 0;
};

}  // namespace patchmill
