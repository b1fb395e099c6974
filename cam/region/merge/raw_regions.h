// Finds the raw regions: connected areas of equal label, before anything is merged, and their common borders.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/merge/merge_regions.h"
#include "cam/region/split/seams.h"
#include "core/base/run_context.h"

namespace patchmill {

// The summit and the pit that each triangle belongs to (Catchments).
struct Watersheds {
  PerTriangle<int> summit, pit;
};

struct RawRegions {
  PerTriangle<int> of;  // its raw region, numbered by their first triangles
  std::vector<RawRegion> regions;
  std::vector<RawContact> contacts;  // one for each two regions with a common border
};

// A reachable area of one label is divided where its summit or pit changes. Borders are still chords here,
// and areas end at the chords, because merging removes most borders. CANCELLED and DEADLINE_EXCEEDED from
// `run`.
absl::StatusOr<RawRegions> FindRawRegions(const SplitSurface& split, const Watersheds& watersheds,
                                          const RunContext& run);

}  // namespace patchmill
