// T-junctions as links: edges that lie all along a longer edge of another patch.
#pragma once

#include <vector>

#include "core/base/run_context.h"
#include "core/network/edge_curves.h"
#include "core/network/open_edges.h"
#include "core/network/patch_network.h"

namespace patchmill {

// Sorted by whole, then by part, without edges that have a neighbour after all. Places on the whole are exact
// to about 1e-13 of it. Incomplete if `run` is cancelled meanwhile.
std::vector<PartLink> FindPartLinks(const EdgeCurves& curves, const std::vector<EdgeLink>& edges,
                                    const std::vector<TJunction>& junctions, const RunContext& run);

}  // namespace patchmill
