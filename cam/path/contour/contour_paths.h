// Waterlines: level lines of the centre height h ([contours]), spaced for the scallop.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/zlevel/level_trace.h"
#include "core/base/diagnostic.h"
#include "core/base/run_context.h"

namespace patchmill {

struct ContourResult {
  // The parts of the waterlines that are passes. Passes of one level have the same `order_key`. Keys count
  // the levels of a family from the highest down, family after family. A family is a group of levels
  // (level_groups.h), or several groups with the same levels.
  std::vector<CutterPath> paths;
  // CONTOUR_COARSE and CONTOUR_AMBIGUOUS: at most one of each for all levels (contour_findings.h).
  Diagnostics findings;
};
// Plans the levels of each group on its own (PlanLevels), traces them (TracePasses) and clips their loops to
// the passes (ClipLoop, [contours, section 6]). Neighbouring levels are so close that the z-step w_c
// sin(slope) [spacing (7)] holds at all contacts in the slope window. Where only some of the surface needs
// it, there are partial levels. A level lies exactly at the height of each flat and of each lower end of
// faces that is long enough (LevelHeights). Every centre is certified (CertifyCenters).
absl::StatusOr<ContourResult> ContourPaths(const Locator& locator, const ContourParams& params,
                                           const RunContext& run);

}  // namespace patchmill
