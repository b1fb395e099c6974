// Writes a binary tree of boxes as nodes of four children. The nodes may hold other data, too.
#pragma once

#include <vector>

#include <absl/status/status.h>

#include "core/base/parallel.h"
#include "core/base/resize_polling.h"
#include "core/base/status.h"
#include "core/surface/box_node.h"
#include "core/surface/collapse.h"

namespace patchmill {

// Writes children and boxes of `nodes`, which must be empty before. Node is a BoxNode or derives from it;
// nodes[0] is the root. Parallel, except for Collapse. CANCELLED and DEADLINE_EXCEEDED from `run`.
template <typename Node>
absl::Status WriteNodes(const std::vector<SurfaceNode>& binary, const RunContext& run,
                        std::vector<Node>& nodes) {
  PM_ASSIGN_OR_RETURN(const std::vector<FourChildren> all, Collapse(binary, run));
  run.Progress("bounds: boxes", 0.0);
  PM_RETURN_IF_ERROR(ResizePolling(nodes, all.size(), run));
  return ParallelFor(run, "bounds: boxes", all.size(),
                     [&](std::size_t i) { SetBoxes(binary, all[i], nodes[i]); });
}

}  // namespace patchmill
