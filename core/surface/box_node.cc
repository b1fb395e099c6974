#include "core/surface/box_node.h"

#include "core/base/grow.h"
#include "core/base/outward.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/surface/collapse.h"
#include "core/surface/surface.h"

namespace patchmill {

void SetBoxes(const std::vector<SurfaceNode>& binary, const FourChildren& own, BoxNode& node) {
  for (std::size_t k = 0; k < 4; ++k) {
    const Box3 box = k < own.count ? binary[static_cast<std::size_t>(own.binary[k])].box : Box3{};
    node.child[k] = own.child[k];
    node.min_x[k] = RoundDown(box.min.x());
    node.min_y[k] = RoundDown(box.min.y());
    node.min_z[k] = RoundDown(box.min.z());
    node.max_x[k] = RoundUp(box.max.x());
    node.max_y[k] = RoundUp(box.max.y());
    node.max_z[k] = RoundUp(box.max.z());
  }
}

absl::Status MakeBoxNodes(const std::vector<SurfaceNode>& binary, const RunContext& run,
                          std::vector<BoxNode>& nodes) {
  const std::vector<FourChildren> all = Collapse(binary);
  PM_RETURN_IF_ERROR(Grow(nodes, all.size(), run));
  return ParallelFor(run, nullptr, all.size(), [&](std::size_t i) { SetBoxes(binary, all[i], nodes[i]); });
}

}  // namespace patchmill
