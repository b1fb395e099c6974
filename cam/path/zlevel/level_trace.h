// All loops of one level from what is shared between levels.
#pragma once

#include "cam/location/locator.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/path/zlevel/contact_candidates.h"
#include "cam/path/zlevel/near_spots_mask.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

struct ContourParams : PassParams {
  double resolution = 0.1;  // mm: every loop or hole that holds a disc of this diameter is found
};

// One level c of h: the border between {h > c} (forbidden) and {h <= c}, as closed loops, material (forbidden
// side) on the RIGHT of the motion (climb with M3). Vertices lie on the border to 1e-9 mm, corners between
// two contacts are exact, chords are certified ([location T2] / two discs) to the chord tolerance on both
// sides. Nothing is clipped yet.
struct LevelContours {
  double z = 0.0;  // centre height actually used (a level at a flat moves up, by 3e-3 mm at most)
  std::vector<CutterPath> loops;
  // mm, side of the finest cells: an eighth of the resolution asked for. More where that would have taken too
  // many cells: loops and holes are then found if they hold a disc of eight times this.
  double cell = 0.0;
  int ambiguous_cells = 0;           // cells below the resolution left undecided, closed on the safe side
  Vec3 ambiguous_at = Vec3::Zero();  // the first of them
};
LevelContours TraceLevel(const Locator& locator, double z, const ContourParams& params,
                         const RunContext& run);

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
