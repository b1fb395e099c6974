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

// Multiple of the scallop that the requested finish may leave where passes are removed. Two neighbouring
// passes leave as much anywhere (pass_params.h).
inline constexpr double kRedundantLimit = 1.045;
// Ball radii: shortest stretch that is worth removing at the end of an open pass, and elsewhere, where a link
// has to cross the gap.
inline constexpr double kMinRemovedAtEnd = 2.0, kMinRemovedBetween = 8.0;

// Returns the passes without the redundant parts, in their order. A pass that loses a stretch becomes one or
// two others. A stretch is a candidate if, at every point across it to where its neighbours would finish,
// another pass lies within half the step for the scallop there, or if another pass runs close beside it. Of
// two that make each other redundant the shorter is removed. A pass stays that finished a place which would
// exceed kRedundantLimit scallops without it; FindSpots, with RestPassParams.removed, checks the surface near
// it. A pass also stays that is needed for the limit of `parts`, which is kept as well as RestPaths keeps it.
// `parts` are as for RestPaths, one for the whole selected surface or more; candidates are judged by the
// finest scallop of all. `reach` is the ReachLocator of their tolerance. Spirals stay whole. Cost: about one
// query per chord and per two flat step-overs of pass, eight times as many on candidates, and FindSpots near
// what is removed.
absl::StatusOr<std::vector<CutterPath>> RemoveRedundantPasses(const Locator& locator, const Locator& reach,
                                                              std::vector<CutterPath> paths,
                                                              const std::vector<RestPassParams>& parts,
                                                              const RunContext& run);

}  // namespace patchmill
