// Removes redundant passes, and stretches of passes, whose surface others finish. They occur where contours,
// lines, circles and pencil passes of neighbouring regions meet: each kind is planned without the others.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/locator.h"
#include "cam/path/rest/rest_passes.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// Scallops: removal may raise the leftover up to this. Two neighbouring passes may leave as much anywhere
// (pass_params.h).
inline constexpr double kRedundantLimit = 1.045;
// Ball radii: the shortest stretch that is removed at an end of an open pass, and in its middle, where a link
// must then cross the gap.
inline constexpr double kMinRemovedAtEnd = 2.0, kMinRemovedBetween = 8.0;

// Returns the passes without their redundant parts, in their order [spacing, section 8]. A pass that loses a
// stretch becomes one or two passes. A stretch is a candidate in two cases: if every point beside it, as far
// as its neighbours would finish, has another pass within half the step for the scallop; or if another pass
// runs close beside the stretch. If two stretches make each other redundant, the shorter one is removed.
//
// Two conditions are checked with FindSpots (RestPassParams::removed) near what was removed, and passes that
// they need are restored. No place that a removed pass had finished may now have more than kRedundantLimit
// scallops left. And the limit of `parts` holds wherever it held before, as RestPaths keeps it. `parts` are
// those of RestPaths: one for the whole selected surface, or several; the finest scallop of all decides what
// is a candidate. `reach` is the ReachLocator of their tolerance. Spirals stay whole. Cost: about one query
// for each chord and for every two flat step-overs of pass, eight times as many on candidates, and FindSpots
// near what is removed.
absl::StatusOr<std::vector<CutterPath>> RemoveRedundantPasses(const Locator& locator, const Locator& reach,
                                                              std::vector<CutterPath> paths,
                                                              const std::vector<RestPassParams>& parts,
                                                              const RunContext& run);

}  // namespace patchmill
