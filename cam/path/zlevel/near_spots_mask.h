// Places in plan near some points. A level has to be looked at only there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cam/path/zlevel/contact_candidates.h"

namespace patchmill {

class NearSpotsMask {
 public:
  // Holds all places within `reach` (mm, > 0) of one of the points, in x and in y, and some farther ones, up
  // to 1.5 times as far. Its squares measure a quarter of `reach`. They are larger, and hold places farther
  // away, where more than a million would be needed. Cost O(points + squares), 4 bytes a square.
  NearSpotsMask(std::span<const Vec3> points, double reach);

  // Does the cell contain such a place? O(1).
  bool Meets(const XyRect& cell) const;

 private:
  bool Holds(int x0, int x1, int y0, int y1) const;  // does one of these squares count? ends included
  std::int32_t Before(int i, int j) const { return sums_[static_cast<std::size_t>(i * (ny_ + 1) + j)]; }

  Vec2 origin_ = Vec2::Zero();
  double side_ = 1.0;  // mm, of a square
  int nx_ = 0, ny_ = 0;
  std::vector<std::int32_t> sums_;  // number of squares that count before each corner, both ways
};

}  // namespace patchmill
