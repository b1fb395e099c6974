// Makes passes that finish leftover spots.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/rest/leftover_spots.h"

namespace patchmill {

// The kinds of passes. kCentersOnly is for spots where the limits of the operation leave none of the other
// kinds, which run beside the centres of the spots themselves (say, along a forbidden crease).
enum class RestMethod { kPencilRidgeLevel, kCentersOnly };

// Makes one pass after the other, from the worst spot on. A pass runs along the crease at which the spot
// lies; else, on gentle slopes, along the ridge of spots around it (scan lines between their centres); else,
// on walls, along the level through it; else from free centre to free centre of the spots around it. A spot
// that none of these reaches gets a plunge from above, from where the open spots over it end. Where the ball
// has no room (slots, holes of its own size) only free centres and plunges are left; they may gouge by a
// tenth of params.chord_tolerance. Only the parts of a pass that params.operation_limits allows are kept
// (ClipToLimits) and count. Spots that a pass finishes on its way need no pass of their own. Every pass is
// certified to params.chord_tolerance.
absl::StatusOr<std::vector<CutterPath>> RestPassesAt(const Locator& locator,
                                                     const std::vector<LeftoverSpot>& spots,
                                                     const RestPassParams& params, RestMethod method,
                                                     const RunContext& run);

}  // namespace patchmill
