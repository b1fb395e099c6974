#include "cam/verify/rapid.h"

#include <memory>

#include "core/base/status.h"

namespace patchmill {

absl::StatusOr<std::vector<Extreme>> FindRapidsInStock(const Surface& surface,
                                                       const std::vector<CellRect>& roots,
                                                       const SegmentTree& tree, double clear,
                                                       const RunContext& run) {
  constexpr double kSmallest = 0.02;  // mm
  if (tree.empty()) return std::vector<Extreme>{};
  const MakeRootSearch make = [&]() -> RootSearch {
    auto walker = std::make_shared<CellWalker>(surface);
    return [&, walker](const CellRect& root, const Threshold&) {
      Extreme here;
      int hint = -1;
      walker->Walk(root, [&](const SurfaceCell& cell) {
        if (run.Cancelled()) return false;
        const auto nearest = tree.FindNearest(cell.middle, clear + cell.radius - here.value, hint);
        if (nearest.segment < 0) return false;
        hint = nearest.segment;
        if (clear - nearest.distance > here.value) {
          here = {clear - nearest.distance, cell.middle, cell.rect.piece, tree.segment(nearest.segment).move};
        }
        return cell.radius > (here.value > 0.0 ? 5.0 * kSmallest : kSmallest);
      });
      return here;
    };
  };
  PM_ASSIGN_OR_RETURN(Extremes found, SearchRoots(roots, Extreme{}, 0.0, 0.0, make, run, "verify: rapids"));
  return std::move(found.violations);
}

}  // namespace patchmill
