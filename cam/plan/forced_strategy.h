// Ground that passes of one kind do not finish when they are forced upon the whole surface (kStrategy).
#pragma once

#include <functional>
#include <vector>

#include <absl/status/status.h>

#include "cam/plan/job.h"
#include "core/base/run_context.h"

namespace patchmill {

// RegionParams::finished for the strategy of the operation: by how much the step that is needed
// (NeededFineStep, so that the scallop changes no region) exceeds the least, as fractions of the flat one.
// Empty when nothing is forced. `radius`, mm: of ball and stock to leave.
std::function<double(const SurfaceJet&)> FinishedByForced(const Operation& op, double radius);

// Takes the reason kStrategy from regions that are cut otherwise than the operation says, or in a direction
// that is still open, and fills deepest_leftover of those that keep it: at up to 500 places of each, what the
// least step leaves (LeftByStep), or the distance to a ball that touches ground which is finished, if that is
// less. An estimate: passes may come nearer. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::Status MarkUnfinishedByStrategy(const Surface& surface, const Operation& op,
                                      const std::vector<RegionChoice>& choices, double radius,
                                      const RunContext& run, RegionMap& map);

}  // namespace patchmill
