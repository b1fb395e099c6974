// Refines the crossings of a contour to certified chords.
#pragma once

#include <vector>

#include "cam/path/zlevel/level_chains.h"
#include "cam/path/zlevel/level_oracle.h"

namespace patchmill {

struct LoopTolerance {
  double gouge = 0.005;   // mm, of every chord ([location T2])
  double excess = 0.005;  // mm, normal to the surface (two discs, as [location T3])
};

// What a straight move a b leaves at most (mm) above the contacts of its ends: the smallest, over all splits,
// of the larger of the two caps at the ends ([location T3]). Closed form.
double ChordExcess(const LevelOracle& oracle, const LevelPoint& a, const LevelPoint& b);

// Returns a polyline of border points (closed when the chain is), with the forbidden side on the right and
// every chord within tolerance. Corners between two contacts are vertices with both contacts. Points that the
// tolerance does not need are left out. The result is empty if the run is cancelled meanwhile.
std::vector<LevelPoint> RefineLoop(const LevelOracle& oracle, const Chain& chain,
                                   const LoopTolerance& tolerance, const RunContext& run);

}  // namespace patchmill
