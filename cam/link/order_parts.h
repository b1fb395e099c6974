// Orders the parts of a job: each mountain is cut from its top, each basin from its top inwards, and
// neighbours follow each other.
#pragma once

#include <cstddef>
#include <vector>

#include "cam/region/map/region_map.h"
#include "core/base/run_context.h"

namespace patchmill {

// Passes that are cut in one go: the contours of a mountain or basin, or the lines of a region.
struct JobPart {
  std::vector<ComponentId> components;  // those that the passes lie in, rising; empty if unknown
  double height = 0.0;                  // mm, halfway between their lowest and highest centre
};

// Returns the indices of the parts in the order of cutting. No part comes before a higher part beside it. A
// part is beside another if both lie in the same component, if their components share a border, or if only an
// unreachable area lies between them (as around the foot of a boss that no ball gets into). So of many equal
// bosses whose caps are one region, each is cut from its top by itself.
//
// Among the parts that need not wait, a neighbour of the last part comes first, then the highest one, then
// the first one in `parts`. Heights within 0.01 mm count as equal, so parts of a flat area keep their order.
// Deterministic. Cost: O(n m) for n parts and m pairs of components that share a border. Ends early if `run`
// is cancelled.
std::vector<std::size_t> OrderParts(const RegionMap& map, const std::vector<JobPart>& parts,
                                    const RunContext& run);

}  // namespace patchmill
