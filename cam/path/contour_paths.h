// Offset contours: level lines of the centre height h ([contours]), spaced for the scallop.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/locator.h"
#include "cam/path/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/diagnostic.h"
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

struct ContourResult {
  // Clipped to what is a pass (see below); `line` counts the levels from the highest down, those of one
  // ground (level_grounds.h), or of several with the same heights, after those of another.
  std::vector<CutterPath> paths;
  // CONTOUR_COARSE, CONTOUR_AMBIGUOUS: one each for all levels (contour_findings.h).
  Diagnostics findings;
};
// Each ground has levels of its own. They are spaced so that dz = CenterStep sin(slope) holds on all contacts
// in the window, partial levels where only a spot needs them, one level exactly at each flat, silhouette
// bottom and lower end. A part of a loop is a pass where its contact lies in the slope window (dilated by
// half a step along the loop), has z <= c, and is interior or lies on an edge or vertex with (c - p)/R inside
// the normal cone there; all else is clipped with the clip points solved ([contours, section 6]).
// Every centre is certified (CertifyCenters).
absl::StatusOr<ContourResult> ContourPaths(const Locator& locator, const ContourParams& params,
                                           const RunContext& run);

}  // namespace patchmill
