// Finds where the waterline crosses the edges of its cells. Every crossing is found once and shared by both
// cells.
//
// An edge is cut at all vertices on it into stretches. Let l be the length of a stretch. A *direction* of the
// waterline at a place is that from a contact to the place [contours, section 1]; h - c is negative on the
// free side. In two cases the signs of h - c at the ends of the stretch tell how often the waterline crosses
// it [contours T8c]:
// - All directions at places of the waterline on the stretch point the same way along the stretch. Then it
//   crosses at most once.
// - The directions at places of the waterline within l/2 of the stretch span less than a quarter turn. The
//   waterline may then cross more often than the signs tell, but only in pairs of crossings that can be
//   removed: the waterline between the two can be moved to the other side of the stretch without meeting a
//   vertex or another edge. The loops stay the same except for this motion, by at most l/2.
//
// In all other cases the stretch is halved, down to 2e-4 mm. It is halved only down to a quarter of the
// finest cell if both cells beside it are ambiguous, or if too many parts of the surface would have to be
// tested.
#pragma once

#include <vector>

#include "cam/path/zlevel/level_cells.h"
#include "cam/path/zlevel/level_oracle.h"

namespace patchmill {

// A crossing on the rim of one cell, as met on the way counter-clockwise around the rim.
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
