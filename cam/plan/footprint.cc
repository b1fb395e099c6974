#include "cam/plan/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "core/base/progress_throttle.h"
#include "core/surface/tessellate.h"

namespace patchmill {
namespace {

constexpr double kCells = 400.0;  // of the grid, along the longer side of the part
constexpr int kBorderCells = 4;   // free around the part
constexpr int kMostMeshCells = 256;

}  // namespace

Footprint::Footprint(const Surface& surface, const RunContext& run) {
  const Vec3 size = surface.box.max - surface.box.min;
  cell_ = std::max({size.x(), size.y(), 1e-6 * surface.box.Diagonal()}) / kCells;
  low_ = Xy(surface.box.min).array() - kBorderCells * cell_;
  nx_ = 1 + static_cast<int>(size.x() / cell_) + 2 * kBorderCells;
  ny_ = 1 + static_cast<int>(size.y() / cell_) + 2 * kBorderCells;
  covered_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), 0);
  ProgressThrottle throttle;
  for (std::size_t k = 0; k < surface.pieces.size() && !run.Cancelled(); ++k) {
    throttle.ReportIfDue(run, "seen from above", k, surface.pieces.size());
    const Tessellation::PieceMesh mesh = TessellatePiece(surface, PieceId(k), 0.1 * cell_, kMostMeshCells);
    const auto at = [&](int i, int j) -> Vec2 {
      return Xy(mesh.vertices[static_cast<std::size_t>(i * (mesh.nv + 1) + j)].p);
    };
    for (int i = 0; i < mesh.nu; ++i) {
      for (int j = 0; j < mesh.nv; ++j) {
        Cover(at(i, j), at(i + 1, j), at(i, j + 1));
        Cover(at(i + 1, j + 1), at(i + 1, j), at(i, j + 1));
      }
    }
  }
  FloodOutside();
}

bool Footprint::IsOutside(const Vec2& q) const {
  const auto cell = At(q);
  return !cell || outside_[*cell] != 0;
}

bool Footprint::IsBare(const Vec2& q) const {
  const auto cell = At(q);
  return !cell || covered_[*cell] == 0;
}

int Footprint::Cell(double d) const { return static_cast<int>(std::floor(d / cell_)); }

std::optional<std::size_t> Footprint::At(const Vec2& q) const {
  const int x = Cell(q.x() - low_.x()), y = Cell(q.y() - low_.y());
  if (x < 0 || y < 0 || x >= nx_ || y >= ny_) return std::nullopt;
  return Index(x, y);
}

// Marks every cell that the triangle meets, by the axes that may separate the two.
void Footprint::Cover(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 low = a.cwiseMin(b).cwiseMin(c) - low_, high = a.cwiseMax(b).cwiseMax(c) - low_;
  const std::array<Vec2, 3> corners = {a, b, c};
  for (int y = std::max(0, Cell(low.y())); y <= std::min(ny_ - 1, Cell(high.y())); ++y) {
    for (int x = std::max(0, Cell(low.x())); x <= std::min(nx_ - 1, Cell(high.x())); ++x) {
      const Vec2 middle = low_ + cell_ * Vec2(x + 0.5, y + 0.5);
      bool apart = false;
      for (std::size_t k = 0; k < 3 && !apart; ++k) {
        const Vec2 edge = corners[(k + 1) % 3] - corners[k];
        const Vec2 normal(-edge.y(), edge.x());
        const double here = normal.dot(middle - corners[k]);
        const double third = normal.dot(corners[(k + 2) % 3] - corners[k]);
        const double half = 0.5 * cell_ * normal.cwiseAbs().sum();
        apart = here + half < std::min(0.0, third) || here - half > std::max(0.0, third);
      }
      if (!apart) covered_[Index(x, y)] = 1;
    }
  }
}

void Footprint::FloodOutside() {
  outside_.assign(covered_.size(), 0);
  std::deque<std::array<int, 2>> open = {{0, 0}};
  outside_[0] = 1;
  while (!open.empty()) {
    const auto [x, y] = open.front();
    open.pop_front();
    for (const auto& [dx, dy] : {std::array{1, 0}, std::array{-1, 0}, std::array{0, 1}, std::array{0, -1}}) {
      const int nx = x + dx, ny = y + dy;
      if (nx < 0 || ny < 0 || nx >= nx_ || ny >= ny_) continue;
      const std::size_t i = Index(nx, ny);
      if (covered_[i] != 0 || outside_[i] != 0) continue;
      outside_[i] = 1;
      open.push_back({nx, ny});
    }
  }
}

}  // namespace patchmill
