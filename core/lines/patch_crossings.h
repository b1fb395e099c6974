// Curves in which patches cross each other [lines, section 7].
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/lines/zero_curves.h"
#include "core/surface/surface.h"

namespace patchmill {

struct CrossingParams {
  double tolerance = 0.01;  // mm: chords of the curves keep it
  // mm: patches that enter each other by more than twice this, in a part wider than four times this, are
  // found; a loop that is shallower or narrower may be missed.
  double depth = 0.01;
};

// The curves of one pair of patches.
struct PatchCrossing {
  PatchId a, b;  // a < b
  // Points on `a`; those on `b` are the same places. Both surfaces agree there to kCrossingGap.
  std::vector<ZeroCurve> curves;
  double length = 0.0;  // mm
};

inline constexpr double kCrossingGap = 1e-6;  // mm

struct Crossings3d {
  std::vector<PatchCrossing> pairs;  // in order
  // Curves through all patches, put together where one pair ends and the next begins. Points lie on the first
  // patch of their pair.
  std::vector<ZeroCurve> curves;
  bool complete = true;  // false: the surface has so much detail that the depth was raised
  double depth = 0.0;    // mm, as used
};

// Boxes of flat cells find places that are near, cells that cross start curves, and Newton steps on both
// surfaces put every point of a curve onto them. An edge that patches share is no crossing. A patch is not
// compared with itself, nor are patches of one face. A patch that only ends on another touches it; where it
// goes on in a neighbour on the other side, their edge is a crossing. Patches that lie on each other do not
// cross. Two curves nearer to each other than about 4 * depth may be found as one or not at all.
// Deterministic. CANCELLED and DEADLINE_EXCEEDED from `run`, which is polled every 256 cells.
absl::StatusOr<Crossings3d> FindPatchCrossings(const Surface& surface, const CrossingParams& params,
                                               const RunContext& run);

// PATCHES_CROSS for each pair of patches, or of faces; BODIES_CROSS for each pair of bodies of a CAD file.
// All are warnings with length and a place. CROSSINGS_COARSE if the search was not complete.
Diagnostics CrossingFindings(const Surface& surface, const Crossings3d& crossings);

}  // namespace patchmill
