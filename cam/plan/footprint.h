// The area that a surface covers as seen from above, and what lies outside of it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "cam/limits/covered_cells.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// A grid of square cells, 400 along the longer side of the part. A cell that the surface meets is covered;
// the other cells are outside or in holes. Triangles within a tenth of a cell stand for the surface.
class Footprint {
 public:
  // Unusable when the run was cancelled meanwhile. Cost: up to 130,000 triangles a piece.
  Footprint(const Surface& surface, const RunContext& run);

  double cell() const { return grid_.cell; }  // mm, side of a cell
  // True beyond the outer border of the covered area.
  bool IsOutside(const Vec2& q) const;
  // True outside and in holes: the surface is nowhere above or below q.
  bool IsBare(const Vec2& q) const;

 private:
  std::optional<std::size_t> At(const Vec2& q) const;  // nullopt beyond the grid
  void FloodOutside();

  PlanGrid grid_;
  std::vector<char> covered_, outside_;  // by PlanGrid::Index
};

}  // namespace patchmill
