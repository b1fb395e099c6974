// Refines the crossings of a contour to certified chords.
#pragma once

#include <vector>

#include "cam/path/zlevel/level_chains.h"
#include "cam/path/zlevel/level_oracle.h"

namespace patchmill {

struct LoopTolerance {
  double gouge = 0.005;   // mm: how deep a chord may cut [location T2]
  double excess = 0.005;  // mm along the normal: how much a chord may leave (ChordExcess)
};

// Returns an upper bound (mm) for what the chord a b leaves: [location T3] with the contacts of a and b as
// supports, with the best split. Distances to the contacts are those of LevelOracle::Excess. Closed form.
double ChordExcess(const LevelOracle& oracle, const LevelPoint& a, const LevelPoint& b);

// Returns a polyline of points of the waterline, closed if the chain is, with the forbidden side on the right
// and every chord within tolerance. At a corner it has a vertex with both contacts. It has no more vertices
// than the tolerance needs, except in very short loops. Empty if the run is cancelled meanwhile.
std::vector<LevelPoint> RefineLoop(const LevelOracle& oracle, const Chain& chain,
                                   const LoopTolerance& tolerance, const RunContext& run);

}  // namespace patchmill
