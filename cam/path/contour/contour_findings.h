// Findings about what the tracing of contours could not decide, reported once for all levels.
#pragma once

#include <optional>

#include "cam/path/contour/contour_paths.h"
#include "core/base/diagnostic.h"

namespace patchmill {

// Takes levels in order. Of each it keeps only counts, heights and the worst cell.
class ContourFindings {
 public:
  explicit ContourFindings(double resolution) : resolution_(resolution) {}  // mm, as requested

  void Take(const LevelContours& level);

  // Returns at most one finding of each code, at a place of the worst level. CONTOUR_COARSE (warning) says
  // which resolution was held instead of the requested one. CONTOUR_AMBIGUOUS (info) says how many cells were
  // left undecided, and their size.
  Diagnostics Findings() const;

 private:
  struct Levels {
    int count = 0;
    double lowest = 0.0, highest = 0.0;  // mm, height of the centre
    double cell = 0.0;                   // mm, side of the finest cells, the largest of these levels
    std::optional<Vec3> where;           // on the first level with cells of this size
  };
  static void Take(const LevelContours& level, Levels* of);

  double resolution_;
  Levels coarse_, ambiguous_;
  long long undecided_ = 0;
};

}  // namespace patchmill
