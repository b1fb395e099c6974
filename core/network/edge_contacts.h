// Open edges that run along each other for a part of their length only, or with a gap between them.
#pragma once

#include <vector>

#include "core/base/run_context.h"
#include "core/network/patch_network.h"

namespace patchmill {

// A place of edge `self` at which the open edge `other` of another patch runs along it.
struct EdgeContact {
  PatchEdge self, other;
  bool reversed = false;  // the parameters run in opposite directions there
};

// The network joins edges that agree, and shorter edges to the longer edge that they lie along. It leaves
// open the edges that overlap in part, such as two circles whose seams are turned against each other, and
// edges with a gap. This function looks for them at five places of each open edge: within ten join
// tolerances, and within ten degrees of the same direction. Sorted by self, then by other. Incomplete if
// `run` is cancelled meanwhile, or after half a million closest points. `model`: of the network, with all its
// shapes. Cost O(n log n); at most 32 edges are tried at a place.
std::vector<EdgeContact> FindEdgeContacts(const PatchModel& model, const PatchNetwork& network,
                                          const RunContext& run);

}  // namespace patchmill
