// Rough heights of the surface. They estimate the time of low rapids when passes are ordered.
#pragma once

#include <cstddef>
#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

// Largest heights over rectangles of the plan, from the boxes of the surface's leaves on a grid of at most 64
// x 64 squares. A height may be too high, because of something within a square beside the rectangle, but it
// is never too low. It proves nothing: the heights of rapids come from Locator::MaxHeight, and the verifier
// has a grid of its own. Immutable, thread-safe.
class SurfaceHeights {
 public:
  // Everything within `beside` (mm) of a place counts, too. Cost: some ns per leaf, 1.6 MB.
  SurfaceHeights(const Surface& surface, double beside);

  // The largest height over the rectangle with corners a and b and sides along x and y, mm; -infinity if
  // there is no surface. Cost: about 10 ns.
  double HighestOver(const Vec2& a, const Vec2& b) const;

 private:
  static constexpr int kSquares = 64, kLevels = 7;  // kSquares = 2^(kLevels - 1), along each axis
  static std::size_t Index(int level_x, int level_y, int i, int j) {
    return static_cast<std::size_t>(((level_x * kLevels + level_y) * kSquares + i) * kSquares + j);
  }
  int Square(double x, int axis) const;

  Vec2 low_ = Vec2::Zero();
  double step_ = 1.0;
  std::vector<double> highest_;  // [Index]: over 2^level_x by 2^level_y squares from (i, j) on
};

}  // namespace patchmill
