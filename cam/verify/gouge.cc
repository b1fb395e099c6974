#include "cam/verify/gouge.h"

#include <memory>

namespace patchmill {

namespace {

class GougeSearch {
 public:
  GougeSearch(const Surface& surface, const SegmentTree& tree, const GougeParams& params,
              const RunContext& run)
      : walker_(surface), tree_(tree), radius_(params.radius + params.chord_error), run_(run) {
    candidates_.resize(kMaxCellDepth + 2);
  }

  Extreme Run(const CellRect& root, const Threshold& threshold) {
    Extreme here;
    walker_.Walk(root, [&](const SurfaceCell& cell) { return Visit(cell, threshold, here); });
    return here;
  }

 private:
  bool Visit(const SurfaceCell& cell, const Threshold& threshold, Extreme& here) {
    if (run_.Cancelled()) return false;
    if (threshold.Drop(here.value) >= radius_) return false;  // distances are never negative
    const auto depth = static_cast<std::size_t>(cell.depth);
    std::vector<int>& from = candidates_[depth];
    std::vector<int>& to = candidates_[depth + 1];
    if (depth == 0) tree_.FindWithin(cell.middle, radius_ - threshold.Drop(0.0) + cell.radius, from);
    to.clear();
    bool open = false;
    for (const int i : from) {
      const MetricValue f = tree_.DistanceAndGradient(i, cell.middle);
      if (f.distance >= radius_ - threshold.Drop(here.value) + cell.radius) continue;
      if (radius_ - f.distance > here.value) {
        here = {radius_ - f.distance, cell.middle, cell.rect.piece, tree_.segment(i).move};
      }
      // The distance has slope at most 1, which is a second bound. Where it is 0, the gradient is unknown.
      double least = -cell.radius;
      if (f.distance > 0.0) {
        double lowest = kInfinity;
        for (int k = 0; k < cell.hull_count; ++k) {
          lowest = std::min(lowest, f.gradient.dot(cell.hull[k] - cell.middle));
        }
        least = std::max(least, lowest);
      }
      if (f.distance + least >= radius_ - threshold.Drop(here.value)) continue;  // holds for all parts, too
      to.push_back(i);
      open = true;
    }
    return open;
  }

  CellWalker walker_;
  const SegmentTree& tree_;
  double radius_;
  const RunContext& run_;
  std::vector<std::vector<int>> candidates_;  // [depth]: moves that the parent cell could not exclude
};

}  // namespace

absl::StatusOr<Extremes> FindGouge(const RootedSurface& rooted, const SegmentTree& tree,
                                   const GougeParams& params, const RunContext& run, const char* stage) {
  if (tree.empty()) return Extremes{};
  const MakeRootSearch make = [&]() -> RootSearch {
    auto search = std::make_shared<GougeSearch>(rooted.surface, tree, params, run);
    return
        [search](const CellRect& root, const Threshold& threshold) { return search->Run(root, threshold); };
  };
  return SearchRoots(rooted.roots, {Extreme{}, params.limit, params.certainty}, make, run, stage);
}

}  // namespace patchmill
