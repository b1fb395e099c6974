#include "cam/limits/covered_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/progress_throttle.h"
#include "core/surface/tessellate.h"

namespace patchmill {
namespace {

constexpr int kMostMeshCells = 256;
constexpr double kMeshError = 0.1;  // cells

using Triangle = std::array<Vec2, 3>;

// Marks every cell that the triangle meets, by the axes that may separate the two.
void Cover(const PlanGrid& grid, const Triangle& corners, std::vector<char>& covered) {
  const Vec2 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]) - grid.low;
  const Vec2 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]) - grid.low;
  const auto first = [&](double d) { return std::max(0, static_cast<int>(std::floor(d / grid.cell))); };
  const auto last = [&](double d, int n) {
    return std::min(n - 1, static_cast<int>(std::floor(d / grid.cell)));
  };
  for (int y = first(low.y()); y <= last(high.y(), grid.ny); ++y) {
    for (int x = first(low.x()); x <= last(high.x(), grid.nx); ++x) {
      const Vec2 middle = grid.Middle(x, y);
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

}  // namespace

PlanGrid GridOver(const Surface& surface, const GridResolution& resolution) {
  const Vec2 size = Xy(surface.box.max) - Xy(surface.box.min);
  PlanGrid grid;
  grid.cell = std::max(size.maxCoeff(), 1e-6 * surface.box.Diagonal()) / resolution.cells;
  grid.low = Xy(surface.box.min).array() - resolution.beside * grid.cell;
  grid.nx = 1 + static_cast<int>(size.x() / grid.cell) + 2 * resolution.beside;
  grid.ny = 1 + static_cast<int>(size.y() / grid.cell) + 2 * resolution.beside;
  return grid;
}

std::vector<char> CoveredCells(const Surface& surface, const PlanGrid& grid, const char* stage,
                               const RunContext& run) {
  std::vector<char> covered(grid.size(), 0);
  ProgressThrottle throttle;
  for (std::size_t k = 0; k < surface.pieces.size() && !run.Cancelled(); ++k) {
    throttle.ReportIfDue(run, stage, k, surface.pieces.size());
    const Tessellation::PieceMesh mesh =
        TessellatePiece(surface, PieceId(k), kMeshError * grid.cell, kMostMeshCells);
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

}  // namespace patchmill
