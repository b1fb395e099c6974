// Traces all loops of one level from data that levels share.
#pragma once

#include "cam/location/locator.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/path/zlevel/contact_candidates.h"
#include "cam/path/zlevel/near_spots_mask.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

struct ContourParams {
  PassParams pass;
  double resolution = 0.1;  // mm: every loop or hole that holds a disc of this diameter is found
};

// One level c of h: the border between {h > c} (forbidden) and {h <= c}, as closed loops. The material
// (forbidden side) is on the RIGHT of the motion, which is climb with M3. Vertices lie on the border to 1e-9
// mm, corners between two contacts are exact, chords are certified ([location T2] / two discs) to the chord
// tolerance on both sides. Nothing is clipped yet.
struct LevelContours {
  double z = 0.0;  // centre height used (a level at a flat moves up by 1e-3 mm)
  std::vector<CutterPath> loops;
  // mm, side of the finest cells: an eighth of the requested resolution. It is larger where that would have
  // taken too many cells. Loops and holes are then found if they hold a disc of eight times this diameter.
  double cell = 0.0;
  int ambiguous_cells = 0;           // undecided cells below the resolution; they are closed on the safe side
  Vec3 ambiguous_at = Vec3::Zero();  // the first of them
};
LevelContours TraceLevel(const Locator& locator, double z, const ContourParams& params,
                         const RunContext& run);

// The resolution divided by the side of the finest cells; 0.0125 mm for 0.1 mm, [contours, section 2].
inline constexpr double kCellsPerResolution = 8.0;

// Data that do not depend on the level. Users keep references to them. Const after construction.
struct LevelContext {
  // Cost about 3 us a leaf of the surface, in parallel. Unusable if the run was cancelled meanwhile.
  LevelContext(const Locator& locator_in, const RunContext& run)
      : locator(locator_in),
        sides(locator_in.surface(), run),
        bounds(locator_in.surface(), sides, locator_in.radius(), run) {}

  const Locator& locator;
  PieceSides sides;
  LevelBounds bounds;
};

// TraceLevel with a shared context.
LevelContours TraceLevel(const LevelContext& context, double z, const ContourParams& params,
                         const RunContext& run);

// The same, without stretches outside of `where` (null: nothing is outside) and without those whose contacts
// are all on the shank or far outside of params.window. Loops that lose a stretch come as open paths.
LevelContours TracePasses(const LevelContext& context, double z, const NearSpotsMask* where,
                          const ContourParams& params, const RunContext& run);

}  // namespace patchmill
