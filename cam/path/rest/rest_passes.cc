#include "cam/path/rest/rest_passes.h"

#include <algorithm>
#include <memory>

#include "cam/path/rest/leftover_spots.h"
#include "cam/path/rest/spot_passes.h"
#include "core/base/status.h"

namespace patchmill {

absl::StatusOr<std::vector<CutterPath>> RestPaths(const Locator& locator, const Locator& reach,
                                                  const std::vector<CutterPath>& paths,
                                                  const RestPassParams& params, const RunContext& run) {
  std::vector<SurfaceRect> rects;
  rects.reserve(locator.surface().leaves.size());
  for (const SurfaceLeaf& leaf : locator.surface().leaves) {
    rects.push_back({leaf.piece, leaf.u0, leaf.u1, leaf.v0, leaf.v1});
  }
  std::vector<std::unique_ptr<SegmentTree>> owned;
  std::vector<const SegmentTree*> trees;
  const auto grow = [&](const std::vector<CutterPath>& more) {
    owned.push_back(std::make_unique<SegmentTree>(MovesOf(more), Metric::kPath, kInfinity, run));
    trees.push_back(owned.back().get());
  };
  grow(paths);
  std::vector<CutterPath> added;
  RestMethod method = RestMethod::kPencilRidgeLevel;
  for (int round = 0; round < params.max_rounds; ++round) {
    run.Progress("coverage", static_cast<double>(round) / params.max_rounds);
    PM_ASSIGN_OR_RETURN(const std::vector<LeftoverSpot> spots,
                        FindSpots({locator, reach}, trees, rects, params, run));
    if (spots.empty()) break;
    PM_ASSIGN_OR_RETURN(std::vector<CutterPath> found, RestPassesAt(locator, spots, params, method, run));
    // A pass never uncovers anything: only the rectangles of the spots need another look.
    rects.clear();
    for (const LeftoverSpot& s : spots) rects.push_back(s.rect);
    if (found.empty()) {
      if (method == RestMethod::kCentersOnly) break;
      method = RestMethod::kCentersOnly;
      continue;
    }
    grow(found);
    PathAmount made = params.pass.budget.made;
    made += AmountOf(added);
    made += AmountOf(found);
    PM_RETURN_IF_ERROR(CheckAmount(params.pass.budget.limits, made, "with rest passes"));
    for (CutterPath& p : found) {
      p.order_key = static_cast<int>(added.size());
      added.push_back(std::move(p));
    }
  }
  run.Progress("coverage", 1.0);
  return added;
}

}  // namespace patchmill
