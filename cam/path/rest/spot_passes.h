// Turns leftover spots into passes that mend them.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/rest/leftover_spots.h"

namespace patchmill {

// Which passes: kCentersOnly where limits of the operation leave none of the others, which run beside the
// centres
// of the spots themselves (along a crease that is forbidden, say).
enum class RestMethod { kPencilRidgeLevel, kCentersOnly };

// One pass after the other, from the worst spot on: along the crease it lies at, else along the ridge of
// spots around it over gentle ground (scan lines between their centres), else on walls along the level
// through it, else from free centre to free centre of the spots around it; a spot that none of these reaches
// is plunged to from above, from where the open spots over it end. Where the ball has no room (slots, holes
// of its own size) free centres and plunges are all there is: they may gouge by a tenth of
// params.chord_tolerance. Of a pass only what params.operation_limits allows is kept (ClipToLimits)
// and counts. Spots a pass has mended on its way need none of their own. Every pass is certified
// to params.chord_tolerance.
absl::StatusOr<std::vector<CutterPath>> RestPassesAt(const Locator& locator,
                                                     const std::vector<LeftoverSpot>& spots,
                                                     const RestPassParams& params, RestMethod method,
                                                     const RunContext& run);

}  // namespace patchmill
