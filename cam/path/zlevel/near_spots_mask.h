// Places in plan that are near enough to some points: where a level need be looked at.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cam/path/zlevel/contact_candidates.h"

namespace patchmill {

class NearSpotsMask {
 public:
  // All places within `reach` (mm, > 0) of one of the points, each way, and some farther: up to half as far
  // again, more where a million squares of a quarter of that would not do. Cost O(points + squares), 4 bytes
  // a square.
  NearSpotsMask(std::span<const Vec3> points, double reach);

  // Is there such a place in the cell? O(1).
  bool Meets(const XyRect& cell) const;

 private:
  bool Holds(int x0, int x1, int y0, int y1) const;  // one that counts among these squares, ends included
  std::int32_t Before(int i, int j) const { return sums_[static_cast<std::size_t>(i * (ny_ + 1) + j)]; }

  Vec2 origin_ = Vec2::Zero();
  double side_ = 1.0;  // mm, of a square
  int nx_ = 0, ny_ = 0;
  std::vector<std::int32_t> sums_;  // squares that count, of those before each corner both ways
};

}  // namespace patchmill
