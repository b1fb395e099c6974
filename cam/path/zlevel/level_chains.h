// Joins the crossings of the waterline with the edges of its cells into loops.
#pragma once

#include <vector>

#include "cam/path/zlevel/level_edges.h"

namespace patchmill {

// The cell through which the waterline runs from one crossing to the next. It stays inside this cell.
struct ChainCell {
  XyRect bounds;
  // LevelCell::free: each line in this direction meets the stretch once. Zero if the cell is ambiguous.
  Vec2 free = Vec2::Zero();
  // The cell is ambiguous and has more than one stretch. Each stays a straight chord, so that none meets
  // another.
  bool fixed = true;
  bool Ambiguous() const { return free == Vec2::Zero(); }
};
struct ChainPoint {
  LevelPoint point;
  ChainCell onward;
};
struct Chain {
  std::vector<ChainPoint> points;  // forbidden side on the right
  bool closed = true;
};

// Joins the crossings on the rim of each cell in pairs. In a cell that is not ambiguous the pairs follow from
// the order along the waterline [contours T8a]. In an ambiguous cell a chord cuts off each free stretch of
// the rim, so that all else counts as forbidden, which is safe. Loops always close. With `open` they need
// not: the cells are then those of passes only (WantedLevel). Cost O(crossings).
std::vector<Chain> BuildChains(const LevelCells& cells, const LevelEdges& edges, bool open = false);

}  // namespace patchmill
