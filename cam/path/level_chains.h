// Crossings of the contour with the edges of its cells, joined to closed loops.
#pragma once

#include <vector>

#include "cam/path/level_cells.h"
#include "cam/path/level_oracle.h"

namespace patchmill {

// The cell through which the contour runs from one crossing to the next. It stays inside.
struct ChainCell {
  PlanCell bounds;
  Vec2 free = Vec2::Zero();  // unit direction across which the contour is a graph in the cell; zero: no cone
  bool fixed = true;  // no cone and more than one way through: each stays straight, clear of the others
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

// Every edge of a cell is cut at all vertices on it, its crossings are found once and shared by both cells.
// Inside a cell with a cone the crossings are joined in their order along the contour; in an ambiguous cell
// each free stretch of the rim is cut off on its own (the safe side). Loops always close, unless the cells
// are those of passes only (`open`).
std::vector<Chain> BuildChains(LevelCells& cells, const LevelItems& items, const LevelOracle& oracle,
                               const RunContext& run, bool open = false);

}  // namespace patchmill
