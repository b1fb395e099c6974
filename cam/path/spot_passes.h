// Turns leftover spots into passes that mend them.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/leftover_spots.h"

namespace patchmill {

// One pass after the other, from the worst spot on: along the crease it lies at, else along the ridge of
// spots around it over gentle ground (scan lines between their centres), else on walls along the level
// through it; a spot that none of these reaches is touched from above. Spots a pass has mended on its way
// need none of their own. Every pass is certified to params.chord_tolerance.
absl::StatusOr<std::vector<CutterPath>> MendSpots(const Locator& locator,
                                                  const std::vector<LeftoverSpot>& spots,
                                                  const CoverageParams& params, const RunContext& run);

}  // namespace patchmill
