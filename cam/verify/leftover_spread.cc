#include "cam/verify/leftover_spread.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "cam/verify/beyond_strategy.h"
#include "core/base/draw.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {

absl::StatusOr<LeftoverSpread> MeasureSpread(const RootedSurface& rooted, const SegmentTree& tree,
                                             const LeftoverParams& params, const RunContext& run) {
  const Surface& surface = rooted.surface;
  const std::vector<CellRect>& roots = rooted.roots;
  constexpr std::size_t kChunk = 64;  // roots in one task
  const std::size_t chunks = (roots.size() + kChunk - 1) / kChunk;
  std::vector<LeftoverSpread> parts(chunks, LeftoverSpread{});
  PM_RETURN_IF_ERROR(ParallelFor(run, "verify: spread", chunks, [&](std::size_t chunk) {
    int hint = -1;
    Obstacles obstacles;
    const std::size_t end = std::min(roots.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end && !run.Cancelled(); ++i) {
      const CellRect& cell = roots[i];
      const double u = cell.u0 + (cell.u1 - cell.u0) * Draw(2 * i + 1);
      const double v = cell.v0 + (cell.v1 - cell.v0) * Draw(2 * i + 2);
      const SurfaceJet jet = Evaluate(surface, cell.piece, u, v);
      const auto facing = FacingAt(jet);
      const SurfacePoint at{cell.piece, u, v, jet.p};
      if (!facing || !IsWantedAt(surface, params, at)) continue;
      if (ReachOn(surface, at, *facing, params.reach, obstacles) != ReachClass::kReachable) continue;
      const auto nearest = tree.FindNearest(jet.p, kInfinity, hint);
      hint = nearest.segment;
      const double left = nearest.distance - params.reach.radius;
      if (left > params.limit && BeyondStrategy(jet, *facing, params)) continue;
      std::size_t k = 0;
      while (k < kLeftoverEdges.size() && left > kLeftoverEdges[k] * *params.finish.scallop) ++k;
      parts[chunk][k] += (cell.u1 - cell.u0) * (cell.v1 - cell.v0) * jet.du.cross(jet.dv).norm();
    }
  }));
  LeftoverSpread spread{};
  for (const LeftoverSpread& part : parts) {
    for (std::size_t k = 0; k < kLeftoverClasses; ++k) spread[k] += part[k];
  }
  return spread;
}

}  // namespace patchmill
