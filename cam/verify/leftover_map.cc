#include "cam/verify/leftover_map.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

std::array<Vec3, 4> CornersOf(const Surface& surface, const CellRect& cell) {
  const auto at = [&](double u, double v) { return Evaluate(surface, cell.piece, u, v).p; };
  return {at(cell.u0, cell.v0), at(cell.u1, cell.v0), at(cell.u1, cell.v1), at(cell.u0, cell.v1)};
}

}  // namespace

absl::StatusOr<std::vector<LeftoverSample>> SampleLeftover(const RootedSurface& rooted,
                                                           const SegmentTree& tree,
                                                           const LeftoverParams& params,
                                                           const RunContext& run) {
  const std::vector<CellRect>& roots = rooted.roots;
  constexpr std::size_t kChunk = 64;  // roots in one task
  const std::size_t chunks = (roots.size() + kChunk - 1) / kChunk;
  std::vector<std::vector<LeftoverSample>> parts(chunks);
  PM_RETURN_IF_ERROR(ParallelFor(run, "verify: map", chunks, [&](std::size_t chunk) {
    int hint = -1;
    Obstacles obstacles;
    const std::size_t end = std::min(roots.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end && !run.Cancelled(); ++i) {
      const CellRect& cell = roots[i];
      const SurfaceJet jet = Evaluate(rooted.surface, cell.piece, cell.u(), cell.v());
      const auto facing = FacingAt(jet);
      LeftoverSample sample;
      sample.at = {cell.piece, cell.u(), cell.v(), jet.p};
      if (!facing || !IsWantedAt(rooted.surface, params, sample.at)) continue;
      sample.corners = CornersOf(rooted.surface, cell);
      if (ReachOn(rooted.surface, sample.at, *facing, params.reach, obstacles) == ReachClass::kReachable) {
        const auto nearest = tree.FindNearest(jet.p, kInfinity, hint);
        hint = nearest.segment;
        sample.leftover = std::min(nearest.distance - params.reach.radius, params.most);
      }
      parts[chunk].push_back(sample);
    }
  }));
  std::vector<LeftoverSample> samples;
  for (const auto& part : parts) samples.insert(samples.end(), part.begin(), part.end());
  return samples;
}

}  // namespace patchmill
