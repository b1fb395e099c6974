#include "cam/limits/stock_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/status.h"

namespace patchmill {
namespace {

// The grid on which the covered area is found.
constexpr GridResolution kResolution = {.cells = 1500.0, .beside = 8};
constexpr double kLeastStep = 0.01;  // mm

// Replaces values f at 0, 1, ... n-1 by the least (i - k)^2 + f[k] over all k, for each i. It walks along the
// lower envelope of parabolas [references: felzenszwalb2012].
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
  // Returns the place from which on the parabola with apex k lies below the one with apex j < k.
  static double Crossing(const std::vector<double>& f, std::size_t j, std::size_t k) {
    const double a = static_cast<double>(j), b = static_cast<double>(k);
    return 0.5 * (a + b + (f[k] - f[j]) / (b - a));
  }
  std::vector<std::size_t> apex_;
  std::vector<double> from_, values_;
};

// Distances (mm) from the middle of each cell to the middle of the nearest cell that is `wanted`; kFar
// without any.
std::vector<double> DistancesTo(const PlanGrid& grid, const std::vector<char>& cells, char wanted) {
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
  const PlanGrid grid = GridOver(surface, kResolution);
  const std::vector<char> covered = CoveredCells(surface, grid, "stock", run);
  std::vector<char> stands(covered.size());
  for (int y = 0; y < grid.ny; ++y) {
    PM_RETURN_IF_ERROR(run.Check());
    for (int x = 0; x < grid.nx; ++x) {
      const bool bare = covered[grid.Index(x, y)] == 0;
      stands[grid.Index(x, y)] = bare && solid.outline_.SignedDistance(grid.Middle(x, y)) > 0.0 ? 1 : 0;
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
  solid.grid_ = grid;
  solid.accuracy_ = 2.0 * grid.cell;
  for (const Ring& ring : solid.outline_.rings()) {
    for (const Vec2& p : ring) solid.goes_beyond_ = solid.goes_beyond_ || solid.RoomInGrid(p) < 0.0;
  }
  return solid;
}

absl::StatusOr<StockSolid> StockSolid::OfModel(const Surface& model, double top_z, const Surface* roughed,
                                               const RunContext& run) {
  PM_ASSIGN_OR_RETURN(StockColumns columns, StockColumns::Make(model, top_z, roughed, run));
  StockSolid solid;
  solid.top_z_ = top_z;
  if (roughed != nullptr) solid.accuracy_ = columns.accuracy();
  solid.columns_ = std::make_shared<const StockColumns>(std::move(columns));
  return solid;
}

double StockSolid::OnGrid(const Vec2& q) const {
  // Bilinear between the middles of cells.
  const auto place = [&](double d, int n) {
    return std::clamp(d / grid_.cell - 0.5, 0.0, static_cast<double>(n - 1) - 1e-9);
  };
  const double x = place(q.x() - grid_.low.x(), grid_.nx), y = place(q.y() - grid_.low.y(), grid_.ny);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const double s = x - i, t = y - j;
  const auto at = [&](int a, int b) { return static_cast<double>(distance_[grid_.Index(a, b)]); };
  return (1.0 - s) * ((1.0 - t) * at(i, j) + t * at(i, j + 1)) +
         s * ((1.0 - t) * at(i + 1, j) + t * at(i + 1, j + 1));
}

double StockSolid::RoomInGrid(const Vec2& q) const {
  return std::min((q - grid_.low).minCoeff(), (grid_.high() - q).minCoeff());
}

double StockSolid::PlanDistance(const Vec2& q) const {
  if (columns_ != nullptr) return columns_->Distance(Lift(q, -kInfinity));
  if (distance_.empty()) return -outline_.SignedDistance(q);
  const Vec2 inside = q.cwiseMax(grid_.low).cwiseMin(grid_.high());
  const double beside = (q - inside).norm();
  if (beside == 0.0) {
    // Stock beyond the grid is at least as far away as the border of the grid, and as the outline.
    const double beyond = goes_beyond_ ? std::max(RoomInGrid(q), -outline_.SignedDistance(q)) : kInfinity;
    return std::min(OnGrid(q), beyond);
  }
  // Beyond the grid nothing is covered.
  const double out = -outline_.SignedDistance(q);
  return out > 0.0 ? out : std::max(out, -(beside + std::max(0.0, -OnGrid(inside))));
}

double StockSolid::Distance(const Vec3& c) const {
  if (columns_ != nullptr) return columns_->Distance(c);
  const double beside = PlanDistance(Xy(c)), above = c.z() - top_z_;
  if (beside > 0.0 && above > 0.0) return std::hypot(beside, above);
  return std::max(beside, above);
}

double StockSolid::DepthAt(const Vec3& c, const StockDepth& depth) const {
  constexpr double kRise = 1e-3;  // mm
  if (depth.IsOne()) return depth.walls;
  // The distance grows along z by the z component of the normal at the nearest side.
  const double up = (Distance(c + Vec3(0, 0, kRise)) - Distance(c)) / kRise;
  return depth.Along(std::clamp(up, 0.0, 1.0));
}

double StockSolid::CylinderRoom(const Vec2& q, double z, double radius) const {
  if (columns_ != nullptr) return columns_->CylinderRoom(q, z, radius);
  return std::max(PlanDistance(q) - radius, z - top_z_);
}

double StockSolid::Step() const {
  return std::max(kLeastStep, 0.25 * (columns_ != nullptr ? columns_->accuracy() : accuracy_));
}

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

double StockSolid::TopNear(const Vec2& a, const Vec2& b, double distance) const {
  if (columns_ != nullptr) return columns_->TopNear(a, b, distance);
  return RectangleComesNearer(a, b, distance) ? top_z_ : -kInfinity;
}

bool StockSolid::RectangleComesNearer(const Vec2& a, const Vec2& b, double z, double distance) const {
  if (columns_ != nullptr) return columns_->RectangleComesNearer(a, b, z, distance);
  // A place at this height is as near as `beside` in plan.
  const double above = z - top_z_;
  if (above >= distance) return false;
  const double beside = above <= 0.0 ? distance : std::sqrt(distance * distance - above * above);
  return RectangleComesNearer(a, b, beside);
}

bool StockSolid::RectangleComesNearer(const Vec2& a, const Vec2& b, double distance) const {
  if (columns_ != nullptr) return columns_->RectangleComesNearer(a, b, -kInfinity, distance);
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
