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

constexpr std::size_t kLooked = 200;
constexpr std::size_t kFirst = 4;                 // every fourth of them tells about how deep it is
constexpr std::size_t kTighter = 16;              // around the worst
constexpr double kClosest = 0.01, kCloser = 0.4;  // of the radius, and of the last: around the tightest

SurfaceJet JetAt(const Surface& surface, const RegionSample& spot) {
  return Evaluate(surface.pieces[spot.triangle.piece], spot.uv.x(), spot.uv.y());
}

// The larger principal curvature, > 0 concave.
double Bend(const Surface& surface, const RegionSample& spot) {
  const SurfaceJet jet = JetAt(surface, spot);
  const auto normal = UpwardNormal(jet);
  return normal ? Principal(Forms(jet, *normal)).k_max : 0.0;
}

// Where it bends most first: what is found there leaves the others one look each.
void SortByBend(const Surface& surface, std::vector<RegionSample>& spots) {
  std::vector<std::pair<double, RegionSample>> bends;
  for (const RegionSample& spot : spots) bends.emplace_back(Bend(surface, spot), spot);
  std::stable_sort(bends.begin(), bends.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t i = 0; i < spots.size(); ++i) spots[i] = bends[i].second;
}

// Radius of the largest ball that reaches all of a region, at most params.radius; 0 where it would be so
// small that the tolerance decides. First the places given, then ever closer around the worst.
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

void ProbeRegion(const Surface& surface, const std::vector<SplitMesh>& meshes, const ReachTest& reach,
                 const RegionParams& params, std::span<const TriangleRef> triangles, const RunContext& run,
                 Region& region) {
  RegionSamples places(surface, meshes, triangles);
  std::vector<RegionSample> spots = places.Spread(kLooked);
  LeftoverSearch search(reach.free_ball(),
                        {params.floor_z, params.operation_limits, 0.25 * params.tolerance});
  for (std::size_t i = 0; i < spots.size(); i += kFirst) {
    const SurfaceJet jet = JetAt(surface, spots[i]);
    search.AddPoint(jet.p, FacingAt(jet));
  }
  search.Find(run);  // with which most of the triangles are known to be no deeper
  for (const TriangleRef& t : triangles) {
    const SplitMesh& mesh = meshes[t.piece];
    search.AddTriangle(t.piece, {CornerOf(mesh, t.triangle, 0), CornerOf(mesh, t.triangle, 1),
                                 CornerOf(mesh, t.triangle, 2)});
  }
  region.deepest_leftover = search.Find(run).leftover;
  if (run.Cancelled()) return;
  if (region.reason != UnreachableReason::kConcave) return;
  SortByBend(surface, spots);
  region.largest_tool_diameter = 2.0 * BallForAll(surface, spots, params, run, places);
}

}  // namespace patchmill
