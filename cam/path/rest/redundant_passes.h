// Passes, and stretches of them, whose ground others finish: where contours, lines, circles and creases of
// neighbouring regions meet, each of them knows of its own kind only.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/locator.h"
#include "cam/path/rest/rest_passes.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// What a finish that is asked for may exceed the scallop by where passes are taken away, as a share of it: as
// much as two neighbouring passes leave anywhere (pass_params.h).
inline constexpr double kRedundantLimit = 1.045;
// Stretches that are worth taking away, in ball radii: at the end of an open pass, and of others, which need
// a way over the gap.
inline constexpr double kMinRemovedAtEnd = 2.0, kMinRemovedBetween = 8.0;

// The passes without what is needless, in their order; a pass that loses a stretch becomes one or two others.
// Needless seems what has others within half a step for the scallop there all the way across to where its
// neighbours would do, or another right beside it; of two that make each other needless the shorter goes.
// What finished a place that would exceed kRedundantLimit scallops without it stays (FindSpots of the ground
// near it, with RestPassParams.taken), and so does what is needed for the limit of `parts`, which is kept as
// near as RestPaths keeps it. Those are as for RestPaths, one for all wanted ground or more; needless is what
// seems so by the finest scallop of all. `reach`: ReachLocator of their tolerance. Spirals stay whole. Cost
// about one query per chord and per two flat steps of pass, eight times as many on what may be needless, and
// FindSpots near what is taken.
absl::StatusOr<std::vector<CutterPath>> RemoveRedundantPasses(const Locator& locator, const Locator& reach,
                                                              std::vector<CutterPath> paths,
                                                              const std::vector<RestPassParams>& parts,
                                                              const RunContext& run);

}  // namespace patchmill
