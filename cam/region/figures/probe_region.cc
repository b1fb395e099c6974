#include "cam/region/figures/probe_region.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "cam/limits/reach_tolerance.h"
#include "cam/region/figures/leftover.h"
#include "cam/region/figures/region_spots.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr std::size_t kLooked = 200;  // places spread over the region
constexpr std::size_t kFirst = 4;     // every fourth of them gives a first estimate of the depth
constexpr std::size_t kTighter = 16;  // places in each round about the worst one
// Each round about the worst place is kCloser times as wide as the last. The last one is about kClosest
// radii wide.
constexpr double kClosest = 0.01, kCloser = 0.4;

SurfaceJet JetAt(const Surface& surface, const RegionSample& spot) {
  return Evaluate(surface.pieces[spot.triangle.piece], spot.uv.x(), spot.uv.y());
}

// The larger principal curvature, 1/mm, > 0 concave; 0 where there is no normal.
double Bend(const Surface& surface, const RegionSample& spot) {
  const SurfaceJet jet = JetAt(surface, spot);
  const auto normal = UpwardNormal(jet);
  return normal ? Principal(Forms(jet, *normal)).k_max : 0.0;
}

// Sorts by curvature, most concave first. The small ball found there leaves one test for each other place.
void SortByBend(const Surface& surface, std::vector<RegionSample>& spots) {
  std::vector<std::pair<double, RegionSample>> bends;
  for (const RegionSample& spot : spots) bends.emplace_back(Bend(surface, spot), spot);
  std::stable_sort(bends.begin(), bends.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t i = 0; i < spots.size(); ++i) spots[i] = bends[i].second;
}

// Radius of the largest ball that reaches all of a region, at most params.radius. 0 if it would be so small
// that the tolerance decides (SmallestBallRadius). Tests the given places, then others ever closer around the
// worst one.
double BallForAll(const Surface& surface, const std::vector<RegionSample>& spots, const RegionParams& params,
                  const RunContext& run, RegionSamples& more) {
  double radius = params.radius;
  const double least = SmallestBallRadius(ReachTolerance(params.tolerance));
  std::optional<RegionSample> worst;
  const auto look = [&](const std::vector<RegionSample>& at) {
    for (const RegionSample& spot : at) {
      if (run.Cancelled() || radius <= least) return;
      const SurfaceJet jet = JetAt(surface, spot);
      const auto facing = FacingAt(jet);
      if (!facing) continue;
      const double own = LargestFreeRadius(surface, jet.p, *facing, radius, ReachTolerance(params.tolerance));
      if (own >= radius) continue;
      radius = own;
      worst = spot;
    }
  };
  look(spots);
  for (double near = params.radius; worst && near > kClosest * params.radius; near *= kCloser) {
    look(more.Around(*worst, near, kTighter));
  }
  return radius <= least ? 0.0 : radius;
}

}  // namespace

RegionProbe ProbeRegion(const SplitSurface& split, const ReachTest& reach, const RegionParams& params,
                        const UnreachableRegion& region, const RunContext& run) {
  const Surface& surface = *split.surface;
  RegionSamples places(surface, split.meshes, region.triangles);
  std::vector<RegionSample> spots = places.Spread(kLooked);
  LeftoverSearch search(reach.free_ball(),
                        {params.floor_z, params.operation_limits, 0.25 * params.tolerance});
  for (std::size_t i = 0; i < spots.size(); i += kFirst) {
    const SurfaceJet jet = JetAt(surface, spots[i]);
    search.AddPoint(jet.p, FacingAt(jet));
  }
  search.Find(run);  // its centres show at once that most triangles are no deeper
  for (const TriangleRef& t : region.triangles) {
    const SplitMesh& mesh = split.meshes[t.piece];
    search.AddTriangle(t.piece, {CornerOf(mesh, t.triangle, 0), CornerOf(mesh, t.triangle, 1),
                                 CornerOf(mesh, t.triangle, 2)});
  }
  RegionProbe probe;
  probe.deepest_leftover = search.Find(run).leftover;
  if (run.Cancelled() || region.reason != UnreachableReason::kConcave) return probe;
  SortByBend(surface, spots);
  probe.largest_tool_diameter = 2.0 * BallForAll(surface, spots, params, run, places);
  return probe;
}

}  // namespace patchmill
