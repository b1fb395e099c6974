// Short passes that mend a spot are cut on the way from one line to the next where that is quicker than at
// the end.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/link/link_moves.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// `passes` in the order they would be cut. Open border, crease and rest passes no longer than
// MaxLinkLength(params) that are reached over the top go, one after the other, in between two neighbours that
// are no contours, either way round, where the links to and from it (LinkTo, not estimates) take the least
// time together and less than where they are. Of places for each the nearest few are tried; of passes the
// first 256. Nothing else changes its place. Deterministic. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<CutterPath>> InsertPasses(const LinkMaker& maker, std::vector<CutterPath> passes,
                                                     const LinkParams& params, const RunContext& run);

}  // namespace patchmill
