#include "core/surface/part.h"

#include <algorithm>
#include <utility>

#include "core/base/status.h"

namespace patchmill {

absl::StatusOr<Surface> PartOf(const Surface& surface, const std::vector<bool>& patches,
                               const RunContext& run) {
  const PatchModel& whole = surface.network.model;
  PM_CHECK(patches.size() == whole.patches.size());
  PatchModel part;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (patches[i]) part.patches.push_back({whole.patches[i].id, ShapeOf(surface, PatchId(i))});
  }
  // The part keeps the join tolerance of the whole surface, up to the largest one allowed for so small a
  // part.
  part.join_tolerance =
      std::min(surface.network.join_tolerance, kMaxJoinTolerance * ControlBox(part).Diagonal());
  PM_ASSIGN_OR_RETURN(PatchNetwork network, BuildNetwork(std::move(part), run));
  return BuildSurface(std::move(network), SurfaceParams{}, run);
}

}  // namespace patchmill
