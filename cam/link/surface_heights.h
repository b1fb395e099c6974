// How high the ground stands, roughly: what orders passes when rapids stay low.
#pragma once

#include <cstddef>
#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

// Largest heights over rectangles of the plan, from the boxes of the surface's leaves on a grid of at most 64
// x 64 squares: too high by what stands beside within a square, never too low. Nothing is proven by it:
// heights of rapids are Locator::MaxHeight's, and the judge has a grid of its own. Immutable, thread-safe.
class SurfaceHeights {
 public:
  // `beside` mm: what stands that near counts, too. Some ns a leaf, 1.6 MB.
  SurfaceHeights(const Surface& surface, double beside);

  // Of the rectangle with corners a and b and sides along x and y; -infinity where nothing stands. About 10
  // ns.
  double HighestOver(const Vec2& a, const Vec2& b) const;

 private:
  static constexpr int kSquares = 64, kLevels = 7;  // 2^(kLevels - 1) squares
  static std::size_t Index(int level_x, int level_y, int i, int j) {
    return static_cast<std::size_t>(((level_x * kLevels + level_y) * kSquares + i) * kSquares + j);
  }
  int Square(double x, int axis) const;

  Vec2 low_ = Vec2::Zero();
  double step_ = 1.0;
  std::vector<double> highest_;  // of 2^level_x by 2^level_y squares from (i, j) on
};

}  // namespace patchmill
