// The places in plan near some points. A level needs to be traced only there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cam/path/zlevel/contact_candidates.h"

namespace patchmill {

class NearSpotsMask {
 public:
  // Marks squares of a grid so that all places within `reach` (mm, > 0) of a point, in x and in y, are
  // marked. Places up to 1.5 times as far may be marked, too. The side of a square is a quarter of `reach`,
  // or more if the grid would have more than a million squares; then places still farther away may be marked.
  // Cost O(points + squares), 4 bytes a square.
  NearSpotsMask(std::span<const Vec3> points, double reach);

  // True if the cell meets a marked square. O(1).
  bool Meets(const XyRect& cell) const;

 private:
  bool Holds(int x0, int x1, int y0, int y1) const;  // is one of these squares marked? ends included
  std::int32_t Before(int i, int j) const { return sums_[static_cast<std::size_t>(i * (ny_ + 1) + j)]; }

  Vec2 origin_ = Vec2::Zero();
  double side_ = 1.0;  // mm, of a square
  int nx_ = 0, ny_ = 0;
  std::vector<std::int32_t> sums_;  // [corner]: number of marked squares with smaller indices both ways
};

}  // namespace patchmill
