#include "cam/picture/depth_map.h"

#include <algorithm>
#include <cmath>

namespace patchmill {

DepthMap::DepthMap(const Surface& surface, const View& view, const DepthFrame& frame, int cells)
    : view_(view),
      corner_(frame.corner),
      dot_(frame.dot),
      columns_(1 + static_cast<int>(frame.width / frame.dot)),
      rows_(1 + static_cast<int>(frame.height / frame.dot)),
      near_(static_cast<std::size_t>(columns_ * rows_), -kInfinity) {
  std::vector<Vec3> grid(static_cast<std::size_t>((cells + 1) * (cells + 1)));
  const auto at = [&](int i, int j) -> Vec3& { return grid[static_cast<std::size_t>(i * (cells + 1) + j)]; };
  for (const Piece& piece : surface.pieces) {
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells; ++j) {
        at(i, j) = Position(piece, static_cast<double>(i) / cells, static_cast<double>(j) / cells);
      }
    }
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        Fill(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        Fill(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
}

// Fills each dot whose middle lies in the triangle.
void DepthMap::Fill(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec2 p = ToDots(a), q = ToDots(b), r = ToDots(c);
  const double twice = Cross(q - p, r - p);
  if (!(std::abs(twice) > 1e-12)) return;
  const Vec2 low = p.cwiseMin(q).cwiseMin(r), high = p.cwiseMax(q).cwiseMax(r);
  const int i0 = std::max(0, static_cast<int>(std::ceil(low.x()))),
            i1 = std::min(columns_ - 1, static_cast<int>(std::floor(high.x()))),
            j0 = std::max(0, static_cast<int>(std::ceil(low.y()))),
            j1 = std::min(rows_ - 1, static_cast<int>(std::floor(high.y())));
  const double za = view_.Nearness(a), zb = view_.Nearness(b), zc = view_.Nearness(c);
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const Vec2 x(i, j);
      const double wa = Cross(q - x, r - x) / twice, wb = Cross(r - x, p - x) / twice, wc = 1.0 - wa - wb;
      if (wa < 0.0 || wb < 0.0 || wc < 0.0) continue;
      At(i, j) = std::max(At(i, j), wa * za + wb * zb + wc * zc);
    }
  }
}

bool DepthMap::Visible(const Vec3& p, double slack) const {
  const Vec2 x = ToDots(p);
  const int i = static_cast<int>(std::lround(x.x())), j = static_cast<int>(std::lround(x.y()));
  // The farthest of the dots around p counts, so that dots do not cut up a line along an edge or silhouette.
  double farthest = kInfinity;
  for (int di = -1; di <= 1; ++di) {
    for (int dj = -1; dj <= 1; ++dj) {
      if (i + di < 0 || j + dj < 0 || i + di >= columns_ || j + dj >= rows_) return true;
      farthest = std::min(farthest, At(i + di, j + dj));
    }
  }
  return farthest <= view_.Nearness(p) + slack;
}

}  // namespace patchmill
