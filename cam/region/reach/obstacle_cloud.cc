#include "cam/region/reach/obstacle_cloud.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/lanes.h"
#include "core/base/progress_throttle.h"

namespace patchmill {
namespace {

constexpr double kMostPoints = 1e6;  // about, in the whole cloud
constexpr double kCell = 2.0;        // in spacings: side of a cell of the plan
constexpr int kMostCells = 1024;     // cells along x and along y; also points along one side of a piece
constexpr int kLanes = 4;            // cells or points that are examined together
constexpr double kFloat = 1e-6;      // in the size of the surface: bound for the error of float distances

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

// Calls visit(i) for each point of [first, last) whose bit is set in near(i), which tests four points from i
// on. Ends with true when visit returns true.
template <class Near, class Visit>
bool VisitNear(std::size_t first, std::size_t last, const Near& near, const Visit& visit) {
  for (std::size_t i = first; i < last; i += kLanes) {
    unsigned bits = near(i);
    if (last - i < kLanes) bits &= (1U << (last - i)) - 1U;
    for (; bits != 0; bits &= bits - 1) {
      if (visit(i + static_cast<std::size_t>(std::countr_zero(bits)))) return true;
    }
  }
  return false;
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
  ProgressThrottle throttle;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const auto steps = [&](double side) {
      return std::clamp(static_cast<int>(std::ceil(side / spacing)), 1, kMostCells);
    };
    const int nu = steps(sides[k].x()), nv = steps(sides[k].y());
    for (int i = 0; i < nu && !run.Cancelled(); ++i) {
      if (throttle.Due()) {
        throttle.Report();
        run.Progress("obstacles", (static_cast<double>(k) + static_cast<double>(i) / nu) /
                                      static_cast<double>(sides.size()));
      }
      for (int j = 0; j < nv; ++j) {
        const double u = (i + 0.5) / nu, v = (j + 0.5) / nv;
        points.push_back(Position(surface.pieces[k], u, v));
        at.push_back({static_cast<std::int32_t>(k), static_cast<float>(u), static_cast<float>(v)});
      }
    }
  }
  // One loop over a million points takes a tenth of a second.
  const auto cancelled = [&](std::size_t i) { return i % 65536 == 0 && run.Cancelled(); };
  low_ = surface.box.min;
  const Vec3 extent = surface.box.max - low_;
  cell_ = std::max(kCell * spacing, Xy(extent).maxCoeff() / kMostCells);
  slack_ = static_cast<float>(kFloat * extent.norm());
  columns_ = static_cast<int>(extent.x() / cell_) + 1;
  rows_ = static_cast<int>(extent.y() / cell_) + 1;
  const auto place = [&](const Vec3& p) {
    const Vec2 q = Xy(p - low_) / cell_;
    const int column = std::clamp(static_cast<int>(q.x()), 0, columns_ - 1),
              row = std::clamp(static_cast<int>(q.y()), 0, rows_ - 1);
    return static_cast<std::size_t>(row * columns_ + column);
  };
  first_.assign(static_cast<std::size_t>(rows_ * columns_) + 2, 0);
  for (std::size_t i = 0; i < points.size() && !cancelled(i); ++i) ++first_[place(points[i]) + 2];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  highest_.assign(first_.size() - 2 + kLanes, -std::numeric_limits<float>::infinity());
  points_.resize(points.size());
  at_.resize(points.size());
  for (std::vector<float>* rounded : {&x_, &y_, &z_}) rounded->assign(points.size() + kLanes, 0.0F);
  for (std::size_t i = 0; i < points.size() && !cancelled(i); ++i) {
    const std::size_t cell = place(points[i]), at_place = first_[cell + 1]++;
    at_[at_place] = at[i];
    points_[at_place] = points[i];
    const Eigen::Vector3f p = (points[i] - low_).cast<float>();
    x_[at_place] = p.x();
    y_[at_place] = p.y();
    z_[at_place] = p.z();
    highest_[cell] = std::max(highest_[cell], p.z());
  }
}

// Goes through the rows, and through each row by four cells. The points of neighbouring cells form one range.
template <class Visit>
void ObstacleCloud::Runs(const Vec3& c, const double& reach, const Visit& visit) const {
  const Vec3 q = c - low_;
  const Vec2 extent = Vec2(columns_, rows_) * cell_;
  if (q.x() + reach < 0.0 || q.y() + reach < 0.0 || q.x() - reach > extent.x() || q.y() - reach > extent.y())
    return;
  const auto clamped = [&](double x, int count) {
    return static_cast<int>(std::clamp(std::floor(x / cell_), 0.0, static_cast<double>(count - 1)));
  };
  const int last_row = clamped(q.y() + reach, rows_), first = clamped(q.x() - reach, columns_),
            last = clamped(q.x() + reach, columns_);
  const auto width = static_cast<float>(cell_);
  const Float4 zero{}, lefts = Splat(static_cast<float>(first * cell_ - q.x())) +
                               Splat(width) * Float4{0.0F, 1.0F, 2.0F, 3.0F};
  const Float4 top = Splat(static_cast<float>(q.z()));
  for (int row = clamped(q.y() - reach, rows_); row <= last_row; ++row) {
    const double y = std::max({0.0, row * cell_ - q.y(), q.y() - (row + 1) * cell_});
    const Float4 y2 = Splat(static_cast<float>(y * y));
    std::size_t from = 0, to = 0;  // the range so far
    Float4 left = lefts;
    for (int column = first; column <= last; column += kLanes, left = left + Splat(kLanes * width)) {
      const auto cell = static_cast<std::size_t>(row * columns_ + column);
      const Float4 x = Max(zero, Max(left, zero - left - Splat(width))),
                   z = Max(zero, top - Load(highest_, cell));
      unsigned bits = BelowBits(x * x + y2 + z * z, Squared(reach));
      bits &= (1U << std::min<int>(kLanes, last - column + 1)) - 1U;
      for (; bits != 0; bits &= bits - 1) {
        const std::size_t at = cell + static_cast<std::size_t>(std::countr_zero(bits));
        if (first_[at] != to) {
          if (from < to && visit(from, to)) return;
          from = first_[at];
        }
        to = first_[at + 1];
      }
    }
    if (from < to && visit(from, to)) return;
  }
}

// The square of a distance, enlarged by the error of floats.
Float4 ObstacleCloud::Squared(double distance) const {
  const float most = static_cast<float>(distance) + slack_;
  return Splat(1.00001F * most * most);
}

std::optional<SurfacePoint> ObstacleCloud::InTheWay(const Vec3& c, double radius) const {
  std::optional<SurfacePoint> found;
  const Eigen::Vector3f q = (c - low_).cast<float>();
  const Float4 x = Splat(q.x()), y = Splat(q.y()), z = Splat(q.z()), zero{}, most = Squared(radius);
  const auto near = [&](std::size_t i) {
    const Float4 dx = Load(x_, i) - x, dy = Load(y_, i) - y, below = Min(Load(z_, i) - z, zero);
    return BelowBits(dx * dx + dy * dy + below * below, most);
  };
  Runs(c, radius, [&](std::size_t first, std::size_t last) {
    return VisitNear(first, last, near, [&](std::size_t i) {
      const Vec3 d = points_[i] - c;
      const double below = std::min(d.z(), 0.0);
      if (!(Xy(d).squaredNorm() + below * below < radius * radius)) return false;
      found = SurfacePoint{PieceId(at_[i].piece), at_[i].u, at_[i].v, points_[i]};
      return true;
    });
  });
  return found;
}

std::optional<Vec3> ObstacleCloud::Nearest(const Vec3& c, double limit) const {
  double nearest = limit;
  std::optional<Vec3> found;
  const Eigen::Vector3f q = (c - low_).cast<float>();
  const Float4 x = Splat(q.x()), y = Splat(q.y()), z = Splat(q.z());
  Float4 most = Squared(nearest);
  const auto near = [&](std::size_t i) {
    const Float4 dx = Load(x_, i) - x, dy = Load(y_, i) - y, dz = Load(z_, i) - z;
    return BelowBits(dx * dx + dy * dy + dz * dz, most);
  };
  Runs(c, nearest, [&](std::size_t first, std::size_t last) {
    return VisitNear(first, last, near, [&](std::size_t i) {
      const double d = (points_[i] - c).norm();
      if (d >= nearest) return false;
      nearest = d;
      found = points_[i];
      most = Squared(nearest);
      return false;
    });
  });
  return found;
}

}  // namespace patchmill
