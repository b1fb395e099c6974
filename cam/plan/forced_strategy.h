// Areas that passes of one kind do not finish when they are forced upon the whole surface (kStrategy).
#pragma once

#include <functional>

#include <absl/status/statusor.h>

#include "cam/plan/job_context.h"

namespace patchmill {

// RegionParams::finished for the strategy of the operation: by how much the step that is needed
// (NeededFineStep, so that the scallop changes no region) exceeds the least, as fractions of the flat one.
// Empty when nothing is forced. `radius`, mm: of ball and stock to leave.
std::function<double(const SurfaceJet&)> FinishedByForced(const Operation& op, double radius);

// The same map, but for two figures of the regions with the reason kStrategy. A region that is cut otherwise
// than the operation says, or in a direction that is still open, has no reason. The others have their
// deepest_leftover: at up to 500 places of each, what the least step leaves (LeftByStep), or the distance to
// a ball that touches finished surface if that is less. This is an estimate: passes may come nearer.
// CANCELLED, DEADLINE_EXCEEDED from the run.
absl::StatusOr<RegionMap> MarkUnfinishedByStrategy(const JobContext& context, RegionMap map,
                                                   const RegionChoices& chosen);

}  // namespace patchmill
