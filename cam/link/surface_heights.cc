#include "cam/link/surface_heights.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace patchmill {

SurfaceHeights::SurfaceHeights(const Surface& surface, double beside)
    : highest_(static_cast<std::size_t>(kLevels) * kLevels * kSquares * kSquares, -kInfinity) {
  if (surface.box.Empty()) return;
  low_ = Xy(surface.box.min).array() - beside;
  const Vec2 high = Xy(surface.box.max).array() + beside;
  step_ = std::max((high - low_).maxCoeff() / kSquares, 1e-9);
  for (const SurfaceNode& node : surface.nodes) {
    if (node.leaf < 0) continue;
    const int i1 = Square(node.box.max.x() + beside, 0), j1 = Square(node.box.max.y() + beside, 1);
    for (int i = Square(node.box.min.x() - beside, 0); i <= i1; ++i) {
      for (int j = Square(node.box.min.y() - beside, 1); j <= j1; ++j) {
        double& h = highest_[Index(0, 0, i, j)];
        h = std::max(h, node.box.max.z());
      }
    }
  }
  // Each entry follows from two of half the size. Entries that would reach beyond the grid are never used.
  for (int lx = 0; lx < kLevels; ++lx) {
    for (int ly = lx == 0 ? 1 : 0; ly < kLevels; ++ly) {
      const int dx = lx == 0 ? 0 : 1 << (lx - 1), dy = lx == 0 ? 1 << (ly - 1) : 0;
      const int from_x = std::max(0, lx - 1), from_y = lx == 0 ? ly - 1 : ly;
      for (int i = 0; i + (1 << lx) <= kSquares; ++i) {
        for (int j = 0; j + (1 << ly) <= kSquares; ++j) {
          highest_[Index(lx, ly, i, j)] = std::max(highest_[Index(from_x, from_y, i, j)],
                                                   highest_[Index(from_x, from_y, i + dx, j + dy)]);
        }
      }
    }
  }
}

int SurfaceHeights::Square(double x, int axis) const {
  return static_cast<int>(std::clamp(std::floor((x - low_[axis]) / step_), 0.0, kSquares - 1.0));
}

double SurfaceHeights::HighestOver(const Vec2& a, const Vec2& b) const {
  const int i0 = Square(std::min(a.x(), b.x()), 0), i1 = Square(std::max(a.x(), b.x()), 0),
            j0 = Square(std::min(a.y(), b.y()), 1), j1 = Square(std::max(a.y(), b.y()), 1);
  const int lx = std::bit_width(static_cast<unsigned>(i1 - i0 + 1)) - 1,
            ly = std::bit_width(static_cast<unsigned>(j1 - j0 + 1)) - 1;
  const int i2 = i1 + 1 - (1 << lx), j2 = j1 + 1 - (1 << ly);
  return std::max({highest_[Index(lx, ly, i0, j0)], highest_[Index(lx, ly, i2, j0)],
                   highest_[Index(lx, ly, i0, j2)], highest_[Index(lx, ly, i2, j2)]});
}

}  // namespace patchmill
