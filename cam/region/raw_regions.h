// Connected parts of equal label, before anything is merged, and what they have in common.
#pragma once

#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/border_arcs.h"
#include "cam/region/merge_regions.h"
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
  BorderArcs arcs;                   // of their borders
};

// Ground of one label is divided where summits or pits change. Areas include the lenses between chords and
// true curves, those refined to `tolerance` (mm). CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<RawRegions> FindRawRegions(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                          const AdjacencyList& adjacency, const Watersheds& watersheds,
                                          std::span<const ZeroField> fields, double tolerance,
                                          const RunContext& run);

}  // namespace patchmill
