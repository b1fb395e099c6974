#include "cam/path/zlevel/near_spots_mask.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

// Most squares: beyond it squares grow.
constexpr double kMostSquares = 1e6;
constexpr int kPerReach = 4;  // squares per `reach`

}  // namespace

NearSpotsMask::NearSpotsMask(std::span<const Vec3> points, double reach) : side_(reach / kPerReach) {
  Box3 box;
  for (const Vec3& p : points) box.Add(p);
  if (box.Empty()) return;
  const Vec2 size = Xy(box.max - box.min);
  constexpr int kEdge = kPerReach + 1;  // squares added on each side of the points: one more than `reach`,
                                        // which may end inside a square
  const auto squares = [&](double extent) { return extent / side_ + 2.0 * kEdge + 1.0; };
  while (squares(size.x()) * squares(size.y()) > kMostSquares) side_ *= 2.0;
  origin_ = Xy(box.min) - Vec2::Constant(kEdge * side_);
  nx_ = static_cast<int>(squares(size.x()));
  ny_ = static_cast<int>(squares(size.y()));
  sums_.assign(static_cast<std::size_t>((nx_ + 1) * (ny_ + 1)), 0);
  const auto at = [&](int i, int j) -> std::int32_t& {
    return sums_[static_cast<std::size_t>((i + 1) * (ny_ + 1) + j + 1)];
  };
  const auto add_up = [&] {
    for (int i = 0; i < nx_; ++i) {
      std::int32_t row = 0;
      for (int j = 0; j < ny_; ++j) {
        row += at(i, j);
        at(i, j) = Before(i, j + 1) + row;
      }
    }
  };
  for (const Vec3& p : points) {
    const Vec2 q = (Xy(p) - origin_) / side_;
    at(std::clamp(static_cast<int>(q.x()), 0, nx_ - 1), std::clamp(static_cast<int>(q.y()), 0, ny_ - 1)) = 1;
  }
  add_up();
  std::vector<std::int32_t> counts(static_cast<std::size_t>(nx_ * ny_));
  for (int i = 0; i < nx_; ++i) {
    for (int j = 0; j < ny_; ++j) {
      counts[static_cast<std::size_t>(i * ny_ + j)] = Holds(i - kEdge, i + kEdge, j - kEdge, j + kEdge);
    }
  }
  for (int i = 0; i < nx_; ++i)
    for (int j = 0; j < ny_; ++j) at(i, j) = counts[static_cast<std::size_t>(i * ny_ + j)];
  add_up();
}

bool NearSpotsMask::Holds(int x0, int x1, int y0, int y1) const {
  x0 = std::clamp(x0, 0, nx_ - 1);
  x1 = std::clamp(x1, 0, nx_ - 1) + 1;
  y0 = std::clamp(y0, 0, ny_ - 1);
  y1 = std::clamp(y1, 0, ny_ - 1) + 1;
  return Before(x1, y1) - Before(x0, y1) - Before(x1, y0) + Before(x0, y0) > 0;
}

bool NearSpotsMask::Meets(const XyRect& cell) const {
  if (nx_ == 0) return false;
  const Vec2 lo = (cell.mid - cell.half - origin_) / side_, hi = (cell.mid + cell.half - origin_) / side_;
  if (hi.x() < 0.0 || hi.y() < 0.0 || lo.x() >= nx_ || lo.y() >= ny_) return false;
  const auto square = [](double at, int count) {
    return static_cast<int>(std::clamp(std::floor(at), 0.0, count - 1.0));
  };
  return Holds(square(lo.x(), nx_), square(hi.x(), nx_), square(lo.y(), ny_), square(hi.y(), ny_));
}

}  // namespace patchmill
