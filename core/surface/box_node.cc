#include "core/surface/box_node.h"

#include "core/base/round_outward.h"
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

}  // namespace patchmill
