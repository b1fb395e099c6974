// Connected parts of equal label, before anything is merged, and what they have in common.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/merge/merge_regions.h"
#include "cam/region/split/seams.h"
#include "core/base/run_context.h"

namespace patchmill {

// Which summit and which pit every triangle belongs to: [piece][triangle].
struct Watersheds {
  std::vector<std::vector<int>> summit, pit;
};

struct RawRegions {
  std::vector<std::vector<int>> of;  // [piece][triangle]: its raw region, in order of their first triangles
  std::vector<RawRegion> regions;
  std::vector<RawContact> contacts;  // one for any two regions with a common border
};

// Ground of one label is divided where summits or pits change. Borders are still chords, areas end at them:
// most go when regions are merged. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<RawRegions> FindRawRegions(const std::vector<SplitMesh>& meshes,
                                          const AdjacencyList& adjacency, const Watersheds& watersheds,
                                          const RunContext& run);

}  // namespace patchmill
