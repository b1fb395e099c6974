// Makes passes that finish leftover spots.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/rest/leftover_spots.h"

namespace patchmill {

// Which kinds of passes are tried. kPencilRidgeLevel: all kinds, in the order below. kCentersOnly: only
// passes from free centre to free centre, and plunges. Use it for spots at which the limits of the operation
// left nothing of the other kinds, for example beside a crease that is forbidden.
enum class RestMethod { kPencilRidgeLevel, kCentersOnly };

// Returns passes that finish the spots, from the worst spot on. For each spot these kinds are tried in this
// order:
// - a pencil pass, if the spot lies at a re-entrant crease;
// - on gentle slopes, scan lines along the ridge of spots around it, from centre to centre;
// - on walls, the waterline through it;
// - a pass from free centre to free centre of the spots around it;
// - a plunge from above. It starts above the open spots that lie over the spot.
//
// Where the ball has no room (slots, holes of its own size) only the last two kinds can reach the spot; they
// may gouge by a tenth of ReachTolerance, and by 1.2 of it where the ball enters only thanks to it. Passes
// are clipped to params.operation_limits (ClipToLimits). A spot that an earlier pass finishes gets no pass of
// its own. Pencil passes are certified to params.pass.chord_tolerance, all others to ReachTolerance: no arcs
// may be fitted to these (PassKind::kRest).
absl::StatusOr<std::vector<CutterPath>> RestPassesAt(const Locator& locator,
                                                     const std::vector<LeftoverSpot>& spots,
                                                     const RestPassParams& params, RestMethod method,
                                                     const RunContext& run);

}  // namespace patchmill
