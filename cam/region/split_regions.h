// Splits a surface into regions: runs all stages of cam/region in their order [regions].
#pragma once

#include <absl/status/statusor.h>

#include "cam/region/map/region_map.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// Deterministic. Cost: some 10 us per triangle of the split, in parallel. INVALID_ARGUMENT if the radius is
// outside the locator's range. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<RegionMap> SplitRegions(const Surface& surface, const RegionParams& params,
                                       const RunContext& run);

}  // namespace patchmill
