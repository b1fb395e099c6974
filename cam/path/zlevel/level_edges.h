// Where the contour crosses the edges of its cells. Every crossing is found once and shared by both cells.
//
// An edge is cut at all vertices on it. On each remaining stretch, of length l, the signs of h - c at the
// ends decide how often the contour crosses in two cases ([contours T8c]):
//  - The contour's directions at the zeros on the stretch are all one way along it: it crosses at most once.
//  - Its directions at the zeros within l/2 of the stretch, on both sides, span less than a quarter turn.
//    If the signs at the ends hide a pair of crossings, the contour between these has all its tangents
//    within a quarter turn of the stretch. It stays in the right-angled triangle over the pair, of height
//    <= l/2. No vertex and no other edge reaches in there (both cells are at least l wide). So the pair can
//    be removed by moving the contour there, and the rest keeps its topology (proof: [contours T8c]).
// Otherwise the stretch is halved, down to 2e-4 mm. The limit is a quarter of the finest cell where
// only ambiguous cells are beside it, or too much of the surface would have to be looked at.
#pragma once

#include <vector>

#include "cam/path/zlevel/level_cells.h"
#include "cam/path/zlevel/level_oracle.h"

namespace patchmill {

// A crossing as one cell meets it on the way round its rim, counter-clockwise.
struct RimCrossing {
  std::int32_t crossing = 0;
  bool to_free = false;  // forbidden before the crossing, free after it
};

struct LevelEdges {
  std::vector<LevelPoint> crossings;
  std::vector<RimCrossing> rims;           // slices by cell, in order round the cell's rim
  std::vector<std::int32_t> first_on_rim;  // by cell, one more at the end
};

// The result is incomplete if the run is cancelled meanwhile.
LevelEdges FindCrossings(LevelCells& cells, ContactCandidates& items, const LevelOracle& oracle,
                         const RunContext& run);

}  // namespace patchmill
