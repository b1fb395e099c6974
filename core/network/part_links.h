// T-junctions as links: edges that lie all along a longer edge of another patch.
#pragma once

#include <vector>

#include "core/base/run_context.h"
#include "core/network/patch_network.h"

namespace patchmill {

struct PartLink {
  PatchEdge part, whole;
  double from = 0.0, to = 1.0;  // parameters of the whole at the start and end of the part; may run backwards
  double gap = 0.0;             // mm, largest distance found of the part from the whole
};

// By whole, then by part: the edges told by T_JUNCTION findings. Places on the whole to about 1e-13 of it.
// Costs nothing where no edge is on a T-junction, else O(n log n). Incomplete when `run` is cancelled
// meanwhile.
std::vector<PartLink> FindPartLinks(const PatchNetwork& network, const RunContext& run);

}  // namespace patchmill
