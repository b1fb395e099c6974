// Traces all loops of the waterline of one level. LevelContext holds what all levels share.
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

// The waterline at the centre height z: the border between the places in plan where the centre height h is
// above z (forbidden) and the others (free), as loops. The material, on the forbidden side, is on the RIGHT
// of the motion, which is climb milling with M3. Vertices lie on the waterline to 1e-9 mm. Corners, where the
// contact changes, are vertices. Each chord gouges no more than the chord tolerance [location T2] and leaves
// no more than the excess tolerance (loop_refine.h). Loops are not yet clipped to what is a pass.
struct LevelContours {
  double z =
      0.0;  // mm, height of the centre; 1e-3 mm above the requested one if that is the height of a flat
  std::vector<CutterPath> loops;
  // mm, side of the finest cells: an eighth of the requested resolution. It is larger where that would have
  // taken too many cells. Loops and holes are then found if they hold a disc of eight times this diameter.
  double cell = 0.0;
  // Cells that stayed undecided at the finest size. What is in doubt in them counts as forbidden [contours
  // T8d].
  int ambiguous_cells = 0;
  Vec3 ambiguous_at = Vec3::Zero();  // place of the first of them
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

// Traces only what may be a pass: without stretches outside of `where` (null: nothing is outside), and
// without stretches whose contacts are all on the shank or far outside of the slope window. A loop that loses
// a stretch becomes open paths.
LevelContours TracePasses(const LevelContext& context, double z, const NearSpotsMask* where,
                          const ContourParams& params, const RunContext& run);

}  // namespace patchmill
