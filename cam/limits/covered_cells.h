// The squares of a grid in plan that a surface meets as seen from above.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// Squares in plan, placed frame.
struct PlanGrid {
  Vec2 low = Vec2::Zero();  // mm, corner of the first cell
  double cell = 1.0;        // mm, side of a cell
  int nx = 0, ny = 0;       // number of cells along x and y

  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x);
  }
  std::size_t size() const { return Index(0, ny); }
  Vec2 Middle(int x, int y) const { return low + cell * Vec2(x + 0.5, y + 0.5); }
  Vec2 high() const { return low + cell * Vec2(nx, ny); }
};

struct GridResolution {
  double cells = 400.0;  // along the longer side of the surface's box
  int beside = 4;        // cells beside the box on each side
};
PlanGrid GridOver(const Surface& surface, const GridResolution& resolution);

// Returns 1 for each cell that the surface meets and 0 for each other, by PlanGrid::Index. Triangles within a
// tenth of a cell stand for the surface. Reports progress as `stage`. Incomplete once `run` is cancelled.
// Cost: up to 130,000 triangles a piece, and some ns for each cell that a triangle's box meets.
std::vector<char> CoveredCells(const Surface& surface, const PlanGrid& grid, const char* stage,
                               const RunContext& run);

}  // namespace patchmill
