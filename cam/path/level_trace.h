// All loops of one level from what is shared between levels.
#pragma once

#include "cam/path/contour_paths.h"
#include "cam/path/level_items.h"
#include "cam/path/plan_mask.h"

namespace patchmill {

// Sides of the finest cells to the resolution; 0.0125 mm for 0.1 mm, [contours, section 2].
inline constexpr double kCellsPerResolution = 8.0;

// What does not depend on the level. References are kept by those who use it; const after construction.
struct LevelContext {
  // Cost about 3 us a leaf of the surface, parallel. Unusable when the run was cancelled meanwhile.
  LevelContext(const Locator& locator_in, const RunContext& run)
      : locator(locator_in),
        sides(locator_in.surface(), run),
        bounds(locator_in.surface(), sides, locator_in.radius(), run) {}

  const Locator& locator;
  PieceSides sides;
  LevelBounds bounds;
};

// TraceLevel on a shared context.
LevelContours TraceLevel(const LevelContext& context, double z, const ContourParams& params,
                         const RunContext& run);

// The same, without the stretches outside of `where` (null: none is) or whose contacts are all on the shank
// or far outside of params.window: loops that lose some come as open paths.
LevelContours TracePasses(const LevelContext& context, double z, const NearSpotsMask* where,
                          const ContourParams& params, const RunContext& run);

}  // namespace patchmill
