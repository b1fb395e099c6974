// Waterlines: level lines of the centre height h ([contours]), spaced for the scallop.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/zlevel/level_trace.h"
#include "core/base/diagnostic.h"
#include "core/base/run_context.h"

namespace patchmill {

struct ContourResult {
  // Clipped to the parts that are passes (see below). `order_key` counts the levels from the highest down.
  // The levels of one group (level_groups.h), or of several with the same heights, come after those of
  // another.
  std::vector<CutterPath> paths;
  // CONTOUR_COARSE and CONTOUR_AMBIGUOUS: at most one of each for all levels (contour_findings.h).
  Diagnostics findings;
};
// Each group of levels is planned on its own. Levels are spaced so that dz = CenterStep sin(slope) holds on
// all contacts in the window. Partial levels lie where only a spot needs them. One level lies exactly at each
// flat, silhouette bottom and lower end. A part of a loop is a pass where its contact lies in the slope
// window (dilated by half a step along the loop), has z <= c, and is interior or lies on an edge or vertex
// with (c - p)/R inside the normal cone there. The rest is clipped off, with the clip points solved
// ([contours, section 6]). Every centre is certified (CertifyCenters).
absl::StatusOr<ContourResult> ContourPaths(const Locator& locator, const ContourParams& params,
                                           const RunContext& run);

}  // namespace patchmill
