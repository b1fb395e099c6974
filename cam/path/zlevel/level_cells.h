// Finds the cells of the plan that the waterline of one level may cross, each with a bound for its directions
// there ([contours T8a, T8b, T8c]). h, c, free and forbidden: level_oracle.h.
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
  // Undecided: the waterline may have too many directions, even in the smallest cell [contours, section 2].
  bool ambiguous = false;
  // Unit direction from every stretch of the waterline in the cell to its free side; not set if ambiguous.
  Vec2 free = Vec2::Zero();
  std::int32_t first_candidate = 0, last_candidate = 0;  // into LevelCells::items
};

struct LevelCells {
  LevelGrid grid;
  std::vector<LevelCell> cells;     // only those that can hold a part of the contour
  std::vector<std::int32_t> items;  // candidates of ContactCandidates, in slices by cell
  GridMap vertices;                 // corners of all cells ever tested; on a longer edge they are T-junctions
  int ambiguous = 0;
  // Too many ambiguous cells, or too many cells tested. In either case nothing else in this struct is usable.
  bool overflow = false, exhausted = false;
  bool cancelled = false;
};

struct LevelCellLimits {
  double smallest = 0.0125;  // mm, side of the finest cells
  int max_ambiguous = 4'000;
  // Cells tested, about five for each cell in the result. This is enough for 150 m of waterline at R = 3 mm.
  int max_cells = 1'000'000;
};

// The part of a level in which passes are wanted.
struct WantedLevel {
  SlopeWindow window;
  const NearSpotsMask* where = nullptr;  // null: everywhere
};

// Searches a quadtree over the box of the surface in plan, widened by R. A loop or hole of the level that is
// in none of the cells returned is smaller than `smallest`. Polls run.Cancelled(). With `wanted`, two kinds
// of cells are left out, too: cells outside of wanted->where, and cells in which every contact is on the
// shank or has its slope outside of the window. The waterline then consists of open pieces that end at such
// cells.
LevelCells FindCells(ContactCandidates& items, const LevelOracle& oracle, const LevelCellLimits& limits,
                     const RunContext& run, const WantedLevel* wanted = nullptr);

XyRect XyRectOf(const LevelGrid& grid, const LevelCell& cell);

}  // namespace patchmill
