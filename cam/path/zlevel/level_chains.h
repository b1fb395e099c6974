// Joins the crossings of the contour with the edges of its cells into loops.
#pragma once

#include <vector>

#include "cam/path/zlevel/level_edges.h"

namespace patchmill {

// The cell through which the contour runs from one crossing to the next. The contour stays inside it.
struct ChainCell {
  XyRect bounds;
  Vec2 free = Vec2::Zero();  // unit direction across which the contour is a graph in the cell; zero: no cone
  bool fixed = true;         // no cone and more than one stretch: each stays straight, clear of the others
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

// Inside a cell with a cone the crossings are joined in their order along the contour ([contours T8a]). In an
// ambiguous cell each free stretch of the rim is cut off on its own, which is the safe side. Loops always
// close, unless the cells are those of passes only (`open`). Cost O(crossings).
std::vector<Chain> BuildChains(const LevelCells& cells, const LevelEdges& edges, bool open = false);

}  // namespace patchmill
