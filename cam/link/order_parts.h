// Which part of a job comes after which: every mountain from its top, every basin from its top inwards,
// neighbours together.
#pragma once

#include <cstddef>
#include <vector>

#include "cam/region/map/region_map.h"
#include "core/base/run_context.h"

namespace patchmill {

// Passes that are cut in one go: the contours of a mountain or a basin, the lines of a region.
struct JobPart {
  std::vector<int> components;  // of regions, that they lie in, rising; empty: not known
  double height = 0.0;          // mm, between their lowest and highest centre
};

// The parts by position. None comes before a higher one beside it: in the same component of a region or in
// one that shares a border with its own, or has only unreachable ground between (the foot of a boss that no
// ball gets into); of many equal bosses, whose caps are one region, each is cut from its top by itself. Of
// those that need not wait a neighbour of the last part goes before others, then the higher, then the first.
// Heights are told apart to 0.01 mm, so that level ground keeps the order it came in. Deterministic; O(n m)
// for n parts and m pairs of components that share a border. Cancelled it ends early.
std::vector<std::size_t> OrderParts(const RegionMap& map, const std::vector<JobPart>& parts,
                                    const RunContext& run);

}  // namespace patchmill
