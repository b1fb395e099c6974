#include "cam/limits/stock_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/progress_throttle.h"
#include "core/base/status.h"
#include "core/surface/net_kernel.h"

namespace patchmill {
namespace {

// The stock's own grid: squares along its longer side, and beside its box.
constexpr GridResolution kColumnGrid = {.cells = 800.0, .beside = 2};
constexpr double kPartSize = 0.4;  // squares: no part of the surface that gives a top is wider in plan
constexpr int kMostHalvings = 40;  // halvings of a piece
constexpr float kNothing = -std::numeric_limits<float>::infinity();

// Raises the tops of squares to those of the surface over them.
class Tops {
 public:
  Tops(const PlanGrid& grid, double top_z, const RunContext& run)
      : grid_(grid), top_z_(top_z), run_(run), tops_(grid.size(), kNothing) {}

  void Add(const Piece& piece) {
    shape_ = {piece.net.degree_u, piece.net.degree_v};
    const auto count = static_cast<std::size_t>(shape_.count());
    nets_.resize(kMostHalvings + 1);
    nets_[0].assign(piece.net.points.begin(), piece.net.points.end());
    nets_[0].resize(2 * count);
    hull_.resize(count);
    Descend(nets_[0].data(), 0);
  }

  std::vector<float> Take() { return std::move(tops_); }

 private:
  struct Squares {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // first and last
  };

  Squares SquaresOf(const Vec3& low, const Vec3& high) const {
    const auto at = [&](double d, int n) {
      return std::clamp(static_cast<int>(std::floor(d / grid_.cell)), 0, n - 1);
    };
    return {at(low.x() - grid_.low.x(), grid_.nx), at(low.y() - grid_.low.y(), grid_.ny),
            at(high.x() - grid_.low.x(), grid_.nx), at(high.y() - grid_.low.y(), grid_.ny)};
  }

  // True if the tops of all squares are at least as high as that.
  bool AreAsHigh(const Squares& s, float z) const {
    for (int y = s.y0; y <= s.y1; ++y) {
      for (int x = s.x0; x <= s.x1; ++x)
        if (tops_[grid_.Index(x, y)] < z) return false;
    }
    return true;
  }

  void Descend(const Vec4* points, int depth) {
    if (run_.Cancelled()) return;
    const int count = HullPoints(shape_, points, hull_.data());
    if (count == 0) return;
    Vec3 low = hull_[0], high = hull_[0];
    for (int k = 1; k < count; ++k) {
      low = low.cwiseMin(hull_[static_cast<std::size_t>(k)]);
      high = high.cwiseMax(hull_[static_cast<std::size_t>(k)]);
    }
    // Rounded up, so that no column ends below the surface.
    const float z = std::nextafter(static_cast<float>(std::min(high.z(), top_z_)),
                                   std::numeric_limits<float>::infinity());
    const Squares squares = SquaresOf(low, high);
    const Vec2 size = Xy(high) - Xy(low);
    if (size.maxCoeff() <= kPartSize * grid_.cell || depth >= kMostHalvings) {
      for (int y = squares.y0; y <= squares.y1; ++y) {
        for (int x = squares.x0; x <= squares.x1; ++x) {
          float& top = tops_[grid_.Index(x, y)];
          top = std::max(top, z);
        }
      }
      return;
    }
    constexpr double kFew = 4.0;  // squares: so small parts may lie below known stock
    if (size.maxCoeff() <= kFew * grid_.cell && AreAsHigh(squares, z)) return;
    const auto d = static_cast<std::size_t>(depth) + 1;
    const auto net = static_cast<std::size_t>(shape_.count());
    if (nets_[d].size() < 2 * net) nets_[d].resize(2 * net);
    Vec4 *first = nets_[d].data(), *second = first + net;
    HalveNet(shape_, points, LongerAlongU(points), first, second);
    Descend(first, depth + 1);
    Descend(second, depth + 1);
  }

  // By the sides of the net in plan.
  bool LongerAlongU(const Vec4* points) const {
    const auto at = [&](int i, int j) -> Vec2 {
      const Vec4& p = points[i * (shape_.degree_v + 1) + j];
      return p.w() > 0.0 ? Vec2(p.head<2>() / p.w()) : Vec2(Vec2::Zero());
    };
    double u = 0.0, v = 0.0;
    for (const int j : {0, shape_.degree_v / 2, shape_.degree_v}) {
      double length = 0.0;
      for (int i = 0; i < shape_.degree_u; ++i) length += (at(i + 1, j) - at(i, j)).norm();
      u = std::max(u, length);
    }
    for (const int i : {0, shape_.degree_u / 2, shape_.degree_u}) {
      double length = 0.0;
      for (int j = 0; j < shape_.degree_v; ++j) length += (at(i, j + 1) - at(i, j)).norm();
      v = std::max(v, length);
    }
    return u >= v;
  }

  const PlanGrid& grid_;
  double top_z_;
  const RunContext& run_;
  std::vector<float> tops_;
  NetShape shape_;
  std::vector<std::vector<Vec4>> nets_;  // [depth]: both halves
  std::vector<Vec3> hull_;
};

// Distance in plan between two boxes, 0 if they meet.
double Between(const Vec2& low, const Vec2& high, const Vec2& other_low, const Vec2& other_high) {
  return (other_low - high).cwiseMax(low - other_high).cwiseMax(0.0).norm();
}

}  // namespace

absl::StatusOr<StockColumns> StockColumns::Make(const Surface& stock, double top_z, const Surface* roughed,
                                                const RunContext& run) {
  StockColumns columns;
  columns.grid_ = GridOver(stock, kColumnGrid);
  Tops tops(columns.grid_, top_z, run);
  ProgressThrottle throttle;
  for (std::size_t k = 0; k < stock.pieces.size() && !run.Cancelled(); ++k) {
    throttle.ReportIfDue(run, "stock", k, stock.pieces.size());
    tops.Add(stock.pieces[k]);
  }
  PM_RETURN_IF_ERROR(run.Check());
  std::vector<float> heights = tops.Take();
  if (roughed != nullptr) {
    const std::vector<char> covered = CoveredCells(*roughed, columns.grid_, "stock", run);
    PM_RETURN_IF_ERROR(run.Check());
    for (std::size_t k = 0; k < heights.size(); ++k)
      if (covered[k] != 0) heights[k] = kNothing;
  }
  columns.AddLevels(std::move(heights));
  return columns;
}

void StockColumns::AddLevels(std::vector<float> tops) {
  levels_.push_back({grid_.nx, grid_.ny, tops, std::move(tops)});
  while (levels_.back().nx > 1 || levels_.back().ny > 1) {
    const Level& below = levels_.back();
    Level level{(below.nx + 1) / 2, (below.ny + 1) / 2, {}, {}};
    const auto count = static_cast<std::size_t>(level.nx) * static_cast<std::size_t>(level.ny);
    level.highest.assign(count, kNothing);
    level.lowest.assign(count, std::numeric_limits<float>::infinity());
    for (int y = 0; y < below.ny; ++y) {
      for (int x = 0; x < below.nx; ++x) {
        const auto from =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(below.nx) + static_cast<std::size_t>(x);
        const auto to = static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(level.nx) +
                        static_cast<std::size_t>(x / 2);
        level.highest[to] = std::max(level.highest[to], below.highest[from]);
        level.lowest[to] = std::min(level.lowest[to], below.lowest[from]);
      }
    }
    levels_.push_back(std::move(level));
  }
}

double StockColumns::HighestOf(const Square& square) const {
  const Level& level = LevelOf(square);
  return level.highest[static_cast<std::size_t>(square.y) * static_cast<std::size_t>(level.nx) +
                       static_cast<std::size_t>(square.x)];
}

double StockColumns::LowestOf(const Square& square) const {
  const Level& level = LevelOf(square);
  return level.lowest[static_cast<std::size_t>(square.y) * static_cast<std::size_t>(level.nx) +
                      static_cast<std::size_t>(square.x)];
}

Vec2 StockColumns::LowOf(const Square& square) const {
  return grid_.low + std::ldexp(grid_.cell, square.level) * Vec2(square.x, square.y);
}

Vec2 StockColumns::HighOf(const Square& square) const {
  const Vec2 high = grid_.low + std::ldexp(grid_.cell, square.level) * Vec2(square.x + 1, square.y + 1);
  return high.cwiseMin(grid_.high());
}

// Calls visit(square). If the answer is true, the four squares below follow, the one nearest to q first.
template <class Visit>
void StockColumns::Descend(const Square& square, const Vec2& q, Visit& visit) const {
  if (!visit(square) || square.level == 0) return;
  const Level& below = levels_[static_cast<std::size_t>(square.level) - 1];
  const Vec2 middle = grid_.low + std::ldexp(grid_.cell, square.level) * Vec2(square.x + 0.5, square.y + 0.5);
  const int nearest = (q.x() > middle.x() ? 1 : 0) + (q.y() > middle.y() ? 2 : 0);
  for (const int step : {0, 1, 2, 3}) {
    const int k = nearest ^ step;
    const Square part{square.level - 1, 2 * square.x + k % 2, 2 * square.y + k / 2};
    if (part.x < below.nx && part.y < below.ny) Descend(part, q, visit);
  }
}

double StockColumns::Distance(const Vec3& c) const {
  const Vec2 q = Xy(c);
  const Vec2 at = (q - grid_.low) / grid_.cell;
  const bool in_grid = at.minCoeff() >= 0.0 && at.x() < grid_.nx && at.y() < grid_.ny;
  double nearest = kInfinity;
  const auto inside = [&] {
    return in_grid && HighestOf({0, static_cast<int>(at.x()), static_cast<int>(at.y())}) > c.z();
  };
  if (!inside()) {
    const auto to_stock = [&](const Square& square) {
      const double top = HighestOf(square);
      if (std::isinf(top)) return false;
      const double beside = Between(q, q, LowOf(square), HighOf(square));
      const double d = c.z() > top ? std::hypot(beside, c.z() - top) : beside;
      if (d >= nearest) return false;
      if (square.level == 0) nearest = d;
      return true;
    };
    Descend(Root(), q, to_stock);
    return nearest;
  }
  // Beyond the grid there is air.
  nearest = std::min((q - grid_.low).minCoeff(), (grid_.high() - q).minCoeff());
  const auto to_air = [&](const Square& square) {
    const double top = LowestOf(square), beside = Between(q, q, LowOf(square), HighOf(square));
    const double d = top > c.z() ? std::hypot(beside, top - c.z()) : beside;
    if (d >= nearest) return false;
    if (square.level == 0) nearest = d;
    return true;
  };
  Descend(Root(), q, to_air);
  return -nearest;
}

bool StockColumns::RectangleComesNearer(const Vec2& a, const Vec2& b, double z, double distance) const {
  const Vec2 low = a.cwiseMin(b), high = a.cwiseMax(b);
  bool nearer = false;
  const auto visit = [&](const Square& square) {
    const double top = HighestOf(square);
    if (nearer || std::isinf(top)) return false;
    const double beside = Between(low, high, LowOf(square), HighOf(square));
    if ((z > top ? std::hypot(beside, z - top) : beside) >= distance) return false;
    nearer = square.level == 0;
    return true;
  };
  Descend(Root(), 0.5 * (low + high), visit);
  return nearer;
}

double StockColumns::CylinderRoom(const Vec2& q, double z, double radius) const {
  double least = kInfinity;
  const auto visit = [&](const Square& square) {
    const double top = HighestOf(square);
    if (std::isinf(top)) return false;
    const double room = std::max(Between(q, q, LowOf(square), HighOf(square)) - radius, z - top);
    if (room >= least) return false;
    if (square.level == 0) least = room;
    return true;
  };
  Descend(Root(), q, visit);
  return least;
}

double StockColumns::TopNear(const Vec2& a, const Vec2& b, double distance) const {
  const Vec2 low = a.cwiseMin(b), high = a.cwiseMax(b);
  double highest = -kInfinity;
  const auto visit = [&](const Square& square) {
    const double top = HighestOf(square);
    if (!(top > highest) || Between(low, high, LowOf(square), HighOf(square)) >= distance) return false;
    if (square.level == 0) highest = top;
    return true;
  };
  Descend(Root(), 0.5 * (low + high), visit);
  return highest;
}

}  // namespace patchmill
