#include "cam/limits/stock_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/progress_throttle.h"
#include "core/base/status.h"
#include "core/surface/tessellate.h"

namespace patchmill {
namespace {

constexpr double kCells = 1500.0;  // of the grid, along the longer side of the part
constexpr int kBorderCells = 8;    // around the part
constexpr int kMostMeshCells = 256;
constexpr double kLeastStep = 0.01;  // mm

// Squares in plan.
struct Grid {
  Vec2 low = Vec2::Zero();
  double cell = 1.0;
  int nx = 0, ny = 0;

  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x);
  }
  int Cell(double d, int n) const {
    return static_cast<int>(std::clamp(std::floor(d / cell), 0.0, static_cast<double>(n - 1)));
  }
};

using Corners = std::array<Vec2, 3>;

// Marks every cell that the triangle meets, by the axes that may separate the two.
void Cover(const Grid& grid, const Corners& corners, std::vector<char>& covered) {
  const Vec2 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]) - grid.low;
  const Vec2 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]) - grid.low;
  for (int y = grid.Cell(low.y(), grid.ny); y <= grid.Cell(high.y(), grid.ny); ++y) {
    for (int x = grid.Cell(low.x(), grid.nx); x <= grid.Cell(high.x(), grid.nx); ++x) {
      const Vec2 middle = grid.low + grid.cell * Vec2(x + 0.5, y + 0.5);
      bool apart = false;
      for (std::size_t k = 0; k < 3 && !apart; ++k) {
        const Vec2 edge = corners[(k + 1) % 3] - corners[k];
        const Vec2 normal(-edge.y(), edge.x());
        const double here = normal.dot(middle - corners[k]);
        const double third = normal.dot(corners[(k + 2) % 3] - corners[k]);
        const double half = 0.5 * grid.cell * normal.cwiseAbs().sum();
        apart = here + half < std::min(0.0, third) || here - half > std::max(0.0, third);
      }
      if (!apart) covered[grid.Index(x, y)] = 1;
    }
  }
}

absl::StatusOr<std::vector<char>> CoveredCells(const Grid& grid, const Surface& surface,
                                               const RunContext& run) {
  std::vector<char> covered(grid.Index(0, grid.ny), 0);
  ProgressThrottle throttle;
  for (std::size_t k = 0; k < surface.pieces.size(); ++k) {
    PM_RETURN_IF_ERROR(run.Check());
    throttle.ReportIfDue(run, "stock", k, surface.pieces.size());
    const Tessellation::PieceMesh mesh =
        TessellatePiece(surface, PieceId(k), 0.1 * grid.cell, kMostMeshCells);
    const auto at = [&](int i, int j) -> Vec2 {
      return Xy(mesh.vertices[static_cast<std::size_t>(i * (mesh.nv + 1) + j)].p);
    };
    for (int i = 0; i < mesh.nu; ++i) {
      for (int j = 0; j < mesh.nv; ++j) {
        Cover(grid, {at(i, j), at(i + 1, j), at(i, j + 1)}, covered);
        Cover(grid, {at(i + 1, j + 1), at(i + 1, j), at(i, j + 1)}, covered);
      }
    }
  }
  return covered;
}

// For values f at 0, 1, ... n-1: the least (i - k)^2 + f[k] over all k, for each i, as the lower envelope of
// parabolas (Felzenszwalb and Huttenlocher 2012).
class ParabolaEnvelope {
 public:
  void Transform(std::vector<double>& f) {
    const std::size_t n = f.size();
    apex_.assign(n, 0);
    from_.assign(n + 1, 0.0);
    std::size_t count = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (f[k] == kFar) continue;
      double meets = -kFar;
      while (count > 0) {
        meets = Crossing(f, apex_[count - 1], k);
        if (meets > from_[count - 1]) break;
        --count;
        meets = -kFar;
      }
      apex_[count] = k;
      from_[count] = meets;
      ++count;
    }
    if (count == 0) return;
    values_.resize(n);
    std::size_t at = 0;
    for (std::size_t i = 0; i < n; ++i) {
      while (at + 1 < count && from_[at + 1] <= static_cast<double>(i)) ++at;
      const double d = static_cast<double>(i) - static_cast<double>(apex_[at]);
      values_[i] = d * d + f[apex_[at]];
    }
    f = values_;
  }
  static constexpr double kFar = std::numeric_limits<double>::max();

 private:
  // Where the parabola with apex k falls below the one with apex j < k.
  static double Crossing(const std::vector<double>& f, std::size_t j, std::size_t k) {
    const double a = static_cast<double>(j), b = static_cast<double>(k);
    return 0.5 * (a + b + (f[k] - f[j]) / (b - a));
  }
  std::vector<std::size_t> apex_;
  std::vector<double> from_, values_;
};

// Distances (mm) from the middle of each cell to the middle of the nearest cell that is `wanted`; kFar
// without any.
std::vector<double> DistancesTo(const Grid& grid, const std::vector<char>& cells, char wanted) {
  std::vector<double> squares(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    squares[i] = cells[i] == wanted ? 0.0 : ParabolaEnvelope::kFar;
  ParabolaEnvelope envelope;
  std::vector<double> line(static_cast<std::size_t>(grid.nx));
  for (int y = 0; y < grid.ny; ++y) {
    for (int x = 0; x < grid.nx; ++x) line[static_cast<std::size_t>(x)] = squares[grid.Index(x, y)];
    envelope.Transform(line);
    for (int x = 0; x < grid.nx; ++x) squares[grid.Index(x, y)] = line[static_cast<std::size_t>(x)];
  }
  line.resize(static_cast<std::size_t>(grid.ny));
  for (int x = 0; x < grid.nx; ++x) {
    for (int y = 0; y < grid.ny; ++y) line[static_cast<std::size_t>(y)] = squares[grid.Index(x, y)];
    envelope.Transform(line);
    for (int y = 0; y < grid.ny; ++y) squares[grid.Index(x, y)] = line[static_cast<std::size_t>(y)];
  }
  for (double& square : squares) {
    if (square != ParabolaEnvelope::kFar) square = grid.cell * std::sqrt(square);
  }
  return squares;
}

}  // namespace

StockSolid StockSolid::Whole(Outline outline, double top_z) {
  StockSolid solid;
  solid.outline_ = std::move(outline);
  solid.top_z_ = top_z;
  return solid;
}

absl::StatusOr<StockSolid> StockSolid::Roughed(Outline outline, double top_z, const Surface& surface,
                                               const RunContext& run) {
  StockSolid solid = Whole(std::move(outline), top_z);
  const Vec2 size = Xy(surface.box.max) - Xy(surface.box.min);
  Grid grid;
  grid.cell = std::max(size.maxCoeff(), 1e-6 * surface.box.Diagonal()) / kCells;
  grid.low = Xy(surface.box.min).array() - kBorderCells * grid.cell;
  grid.nx = 1 + static_cast<int>(size.x() / grid.cell) + 2 * kBorderCells;
  grid.ny = 1 + static_cast<int>(size.y() / grid.cell) + 2 * kBorderCells;
  PM_ASSIGN_OR_RETURN(const std::vector<char> covered, CoveredCells(grid, surface, run));
  std::vector<char> stands(covered.size());
  for (int y = 0; y < grid.ny; ++y) {
    PM_RETURN_IF_ERROR(run.Check());
    for (int x = 0; x < grid.nx; ++x) {
      const Vec2 middle = grid.low + grid.cell * Vec2(x + 0.5, y + 0.5);
      stands[grid.Index(x, y)] =
          covered[grid.Index(x, y)] == 0 && solid.outline_.SignedDistance(middle) > 0.0 ? 1 : 0;
    }
  }
  const std::vector<double> to_solid = DistancesTo(grid, stands, 1), to_air = DistancesTo(grid, stands, 0);
  solid.distance_.resize(stands.size());
  const double half = 0.5 * grid.cell;
  const double far = 2.0 * grid.cell * (grid.nx + grid.ny);  // no cell of the other kind
  for (std::size_t i = 0; i < stands.size(); ++i) {
    const double d = stands[i] != 0 ? -(std::min(to_air[i], far) - half) : std::min(to_solid[i], far) - half;
    solid.distance_[i] = static_cast<float>(d);
  }
  solid.cell_ = grid.cell;
  solid.low_ = grid.low;
  solid.nx_ = grid.nx;
  solid.ny_ = grid.ny;
  for (const Ring& ring : solid.outline_.rings()) {
    for (const Vec2& p : ring) solid.goes_beyond_ = solid.goes_beyond_ || solid.RoomInGrid(p) < 0.0;
  }
  return solid;
}

double StockSolid::OnGrid(const Vec2& q) const {
  // Bilinear between the middles of cells.
  const auto place = [&](double d, int n) {
    return std::clamp(d / cell_ - 0.5, 0.0, static_cast<double>(n - 1) - 1e-9);
  };
  const double x = place(q.x() - low_.x(), nx_), y = place(q.y() - low_.y(), ny_);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const double s = x - i, t = y - j;
  const auto at = [&](int a, int b) {
    return static_cast<double>(
        distance_[static_cast<std::size_t>(b) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(a)]);
  };
  return (1.0 - s) * ((1.0 - t) * at(i, j) + t * at(i, j + 1)) +
         s * ((1.0 - t) * at(i + 1, j) + t * at(i + 1, j + 1));
}

double StockSolid::RoomInGrid(const Vec2& q) const {
  const Vec2 high = low_ + cell_ * Vec2(nx_, ny_);
  return std::min((q - low_).minCoeff(), (high - q).minCoeff());
}

double StockSolid::PlanDistance(const Vec2& q) const {
  if (distance_.empty()) return -outline_.SignedDistance(q);
  const Vec2 high = low_ + cell_ * Vec2(nx_, ny_);
  const Vec2 inside = q.cwiseMax(low_).cwiseMin(high);
  const double beside = (q - inside).norm();
  if (beside == 0.0) {
    // What stands beyond the grid is at least as far away as its border, and as the outline.
    const double beyond = goes_beyond_ ? std::max(RoomInGrid(q), -outline_.SignedDistance(q)) : kInfinity;
    return std::min(OnGrid(q), beyond);
  }
  // Beyond the grid nothing is covered.
  const double out = -outline_.SignedDistance(q);
  return out > 0.0 ? std::max(out, 0.0) : std::max(out, -(beside + std::max(0.0, -OnGrid(inside))));
}

double StockSolid::Distance(const Vec3& c) const {
  const double beside = PlanDistance(Xy(c)), above = c.z() - top_z_;
  if (beside > 0.0 && above > 0.0) return std::hypot(beside, above);
  return std::max(beside, above);
}

double StockSolid::Step() const { return std::max(kLeastStep, 0.5 * cell_); }

bool StockSolid::SegmentComesNearer(const Vec3& a, const Vec3& b, double distance) const {
  const Vec3 along = std::isinf(a.z()) ? Lift(Xy(b) - Xy(a), 0.0) : Vec3(b - a);
  const double length = along.norm();
  for (double gone = 0.0;;) {
    const Vec3 c = length > 0.0 ? Vec3(a + gone / length * along) : a;
    const double room = Distance(c) - distance;
    if (room < 0.0) return true;
    if (gone >= length) return false;
    gone = std::min(length, gone + std::max(room, Step()));
  }
}

bool StockSolid::RectangleComesNearer(const Vec2& a, const Vec2& b, double distance) const {
  const Vec2 middle = 0.5 * (a + b);
  const double half = 0.5 * (b - a).norm(), room = PlanDistance(middle) - distance;
  if (room < 0.0) return true;
  if (room > half || half < Step()) return false;
  Vec2 size = b - a;
  const int longer = std::abs(size.x()) >= std::abs(size.y()) ? 0 : 1;
  Vec2 near_end = b, far_start = a;
  near_end[longer] = middle[longer];
  far_start[longer] = middle[longer];
  return RectangleComesNearer(a, near_end, distance) || RectangleComesNearer(far_start, b, distance);
}

}  // namespace patchmill
