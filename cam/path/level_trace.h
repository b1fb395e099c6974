// All loops of one level from what is shared between levels.
#pragma once

#include "cam/path/contour_paths.h"
#include "cam/path/level_items.h"

namespace patchmill {

// What does not depend on the level. References are kept by those who use it; const after construction.
struct LevelContext {
  // `all_slopes`: find the slopes of all leaves at once, in parallel; worth it for more than a few levels.
  LevelContext(const Locator& locator_in, const RunContext& run, bool all_slopes = true);

  const Locator& locator;
  PieceSides sides;
  std::vector<SlopeRange> slopes;  // by leaf, or empty
};

// TraceLevel on a shared context.
LevelContours TraceLevel(const LevelContext& context, double z, const ContourParams& params,
                         const RunContext& run);

// The same, without the stretches whose contacts are all on the shank or far outside of params.window: loops
// that lose some come as open paths.
LevelContours TracePasses(const LevelContext& context, double z, const ContourParams& params,
                          const RunContext& run);

}  // namespace patchmill
