#include "cam/region/obstacle_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace patchmill {
namespace {

constexpr double kMostPoints = 1e6;
constexpr double kCell = 2.0;     // spacings
constexpr int kMostCells = 1024;  // along x, and along y
constexpr int kBlock = 8;         // cells looked at together

double LengthAlong(const Piece& piece, bool u) {
  double longest = 0.0;
  for (const double across : {0.0, 0.5, 1.0}) {
    double length = 0.0;
    const auto at = [&](double t) { return u ? Position(piece, t, across) : Position(piece, across, t); };
    for (const double t : {0.0, 0.5}) length += (at(t + 0.5) - at(t)).norm();
    longest = std::max(longest, length);
  }
  return longest;
}

}  // namespace

ObstacleCloud::ObstacleCloud(const Surface& surface, double spacing, const RunContext& run) {
  std::vector<Vec2> sides;
  double area = 0.0;
  for (const Piece& piece : surface.pieces) {
    sides.emplace_back(LengthAlong(piece, true), LengthAlong(piece, false));
    area += sides.back().x() * sides.back().y();
  }
  spacing = std::max(spacing, std::sqrt(area / kMostPoints));
  std::vector<Vec3> points;
  std::vector<Parameters> at;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const auto steps = [&](double side) {
      return std::clamp(static_cast<int>(std::ceil(side / spacing)), 1, kMostCells);
    };
    const int nu = steps(sides[k].x()), nv = steps(sides[k].y());
    for (int i = 0; i < nu && !run.Cancelled(); ++i) {
      for (int j = 0; j < nv; ++j) {
        const double u = (i + 0.5) / nu, v = (j + 0.5) / nv;
        points.push_back(Position(surface.pieces[k], u, v));
        at.push_back({static_cast<std::int32_t>(k), static_cast<float>(u), static_cast<float>(v)});
      }
    }
  }
  low_ = Plan(surface.box.min);
  const Vec2 extent = Plan(surface.box.max) - low_;
  cell_ = std::max(kCell * spacing, extent.maxCoeff() / kMostCells);
  columns_ = static_cast<int>(extent.x() / cell_) + 1;
  rows_ = static_cast<int>(extent.y() / cell_) + 1;
  const auto place = [&](const Vec3& p) {
    const Vec2 q = (Plan(p) - low_) / cell_;
    const int column = std::clamp(static_cast<int>(q.x()), 0, columns_ - 1),
              row = std::clamp(static_cast<int>(q.y()), 0, rows_ - 1);
    return static_cast<std::size_t>(row * columns_ + column);
  };
  first_.assign(static_cast<std::size_t>(rows_ * columns_) + 2, 0);
  for (const Vec3& p : points) ++first_[place(p) + 2];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  highest_.assign(first_.size() - 2 + kBlock, -kInfinity);
  points_.resize(points.size());
  at_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    const std::size_t cell = place(p);
    at_[first_[cell + 1]] = at[i];
    points_[first_[cell + 1]++] = p;
    highest_[cell] = std::max(highest_[cell], p.z());
  }
}

// The walk is by rows, and in these by blocks of cells without branches.
template <class Visit>
void ObstacleCloud::Cells(const Vec3& c, const double& reach, const Visit& visit) const {
  const Vec2 q = Plan(c) - low_;
  const Vec2 extent = Vec2(columns_, rows_) * cell_;
  if (q.x() + reach < 0.0 || q.y() + reach < 0.0 || q.x() - reach > extent.x() || q.y() - reach > extent.y())
    return;
  const auto clamped = [&](double x, int count) {
    return static_cast<int>(std::clamp(std::floor(x / cell_), 0.0, static_cast<double>(count - 1)));
  };
  const int last_row = clamped(q.y() + reach, rows_), first = clamped(q.x() - reach, columns_),
            last = clamped(q.x() + reach, columns_);
  for (int row = clamped(q.y() - reach, rows_); row <= last_row; ++row) {
    const double y = std::max({0.0, row * cell_ - q.y(), q.y() - (row + 1) * cell_});
    for (int column = first; column <= last; column += kBlock) {
      const auto cell = static_cast<std::size_t>(row * columns_ + column);
      const double* highest = &highest_[cell];
      const double from = column * cell_ - q.x();
      std::array<double, kBlock> squared;
      for (std::size_t k = 0; k < kBlock; ++k) {
        const double left = from + static_cast<double>(k) * cell_;
        const double x = std::max(0.0, std::max(left, -left - cell_)), z = std::max(0.0, c.z() - highest[k]);
        squared[k] = x * x + y * y + z * z;
      }
      const auto count = static_cast<std::size_t>(std::min<int>(kBlock, last - column + 1));
      for (std::size_t k = 0; k < count; ++k) {
        if (squared[k] < reach * reach && visit(first_[cell + k], first_[cell + k + 1])) return;
      }
    }
  }
}

std::optional<SurfacePoint> ObstacleCloud::InTheWay(const Vec3& c, double radius) const {
  std::optional<SurfacePoint> found;
  Cells(c, radius, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to && !found; ++i) {
      const Vec3 d = points_[i] - c;
      const double below = std::min(d.z(), 0.0);
      if (Plan(d).squaredNorm() + below * below < radius * radius)
        found = SurfacePoint{PieceId(at_[i].piece), at_[i].u, at_[i].v, points_[i]};
    }
    return found.has_value();
  });
  return found;
}

std::optional<Vec3> ObstacleCloud::Nearest(const Vec3& c, double limit) const {
  double nearest = limit;
  std::optional<Vec3> found;
  Cells(c, nearest, [&](std::size_t from, std::size_t to) {
    double squared = nearest * nearest;
    for (std::size_t i = from; i < to; ++i) {
      const double d = (points_[i] - c).squaredNorm();
      if (d >= squared) continue;
      squared = d;
      found = points_[i];
    }
    nearest = std::min(nearest, std::sqrt(squared));
    return false;
  });
  return found;
}

}  // namespace patchmill
