// Half-spaces that hold the leaves below the nodes of a search tree.
#pragma once

#include <absl/status/status.h>

#include "cam/location/search_tree.h"
#include "core/base/run_context.h"

namespace patchmill::internal {

// Sets up_x, up_y, up_z and top of all nodes from the boxes of the leaves below them. `up` is the mean of
// their normals, weighted by area. It is straight up, with the box's own height, where the normals cancel or
// more than a few thousand leaves lie below. Cost about 0.25 us per leaf. Parallel, deterministic. CANCELLED
// and DEADLINE_EXCEEDED from `run`.
absl::Status BoundByHalfSpaces(const RunContext& run, SearchTree& tree);

}  // namespace patchmill::internal
