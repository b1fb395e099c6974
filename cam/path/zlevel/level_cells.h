// Cells of one level that the contour may cross, each with the directions that the contour can have in it
// ([contours T8a, T8b, T8c]).
#pragma once

#include <cstdint>
#include <vector>

#include "cam/path/zlevel/contact_candidates.h"
#include "cam/path/zlevel/level_oracle.h"
#include "cam/path/zlevel/near_spots_mask.h"
#include "core/base/run_context.h"

namespace patchmill {

// Places in plan as integers on the finest grid.
struct LevelGrid {
  Vec2 origin = Vec2::Zero();
  double unit = 1.0;  // mm, side of the smallest cell
  int levels = 0;     // the root cell has side 2^levels units
  Vec2 At(std::int32_t x, std::int32_t y) const { return origin + unit * Vec2(x, y); }
};

inline std::uint64_t GridKey(std::int32_t x, std::int32_t y) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) | static_cast<std::uint32_t>(y);
}

// A map from keys to int32 with open addressing. It is never iterated, so its order does not matter.
class GridMap {
 public:
  GridMap();
  // Returns the slot of a key; a new slot holds -1. Valid until the next call.
  std::int32_t& operator[](std::uint64_t key);
  bool Contains(std::uint64_t key) const;

 private:
  std::size_t Find(std::uint64_t key) const;
  void Grow();
  std::vector<std::uint64_t> keys_;
  std::vector<std::int32_t> values_;
  std::size_t used_ = 0;
};

struct LevelCell {
  std::int32_t x = 0, y = 0;  // lower left corner
  std::int32_t side = 1;      // units
  bool ambiguous = false;     // no cone was found at the smallest size
  Vec2 free = Vec2::Zero();   // unit direction in which h falls through c, where the cell is not ambiguous
  std::int32_t first_candidate = 0, last_candidate = 0;  // into LevelCells::items
};

struct LevelCells {
  LevelGrid grid;
  std::vector<LevelCell> cells;     // only those that can hold a part of the contour
  std::vector<std::int32_t> items;  // candidates of ContactCandidates, in slices by cell
  GridMap vertices;                 // corners of all cells ever looked at (T-junctions)
  int ambiguous = 0;
  // Too many ambiguous cells; too many cells looked at. In both cases nothing in this struct is usable.
  bool overflow = false, exhausted = false;
  bool cancelled = false;
};

struct LevelCellLimits {
  double smallest = 0.0125;  // mm, side of the finest cells
  int max_ambiguous = 4'000;
  int max_cells = 1'000'000;  // cells looked at, about five for each cell kept: 150 m of contour at R = 3 mm
};

// The part of a level that is looked at.
struct WantedLevel {
  SlopeWindow window;
  const NearSpotsMask* where = nullptr;  // null: everywhere
};

// Searches the quadtree over the plan box of the surface widened by R. Every loop or hole of the level that
// is not in the cells returned is smaller than `smallest`. Polls run.Cancelled(). With `wanted`, cells
// outside of its places are left out too, and cells whose every contact is outside of its slope window or on
// the shank. The contour then comes in pieces that end at such cells.
LevelCells FindCells(ContactCandidates& items, const LevelOracle& oracle, const LevelCellLimits& limits,
                     const RunContext& run, const WantedLevel* wanted = nullptr);

XyRect XyRectOf(const LevelGrid& grid, const LevelCell& cell);

}  // namespace patchmill
