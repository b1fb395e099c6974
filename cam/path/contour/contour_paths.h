// Offset contours: level lines of the centre height h ([contours]), spaced for the scallop.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/zlevel/level_trace.h"
#include "core/base/diagnostic.h"
#include "core/base/run_context.h"

namespace patchmill {

struct ContourResult {
  // Clipped to what is a pass (see below); `line` counts the levels from the highest down, those of one
  // ground (level_groups.h), or of several with the same heights, after those of another.
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
