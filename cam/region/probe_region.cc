#include "cam/region/probe_region.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "cam/region/region_spots.h"
#include "cam/tool/reach_give.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr std::size_t kLooked = 200;
constexpr std::size_t kDeeper = 12, kTighter = 16;  // around the worst, of leftover and of balls
constexpr double kNear = 0.5;                       // of the radius: around the deepest
constexpr double kClosest = 0.01, kCloser = 0.4;    // of the radius, and of the last: around the tightest

SurfaceJet JetAt(const Surface& surface, const RegionSpot& spot) {
  return Evaluate(surface.pieces[spot.triangle.piece], spot.uv.x(), spot.uv.y());
}

// The larger principal curvature, > 0 concave.
double Bend(const Surface& surface, const RegionSpot& spot) {
  const SurfaceJet jet = JetAt(surface, spot);
  const auto normal = UpwardNormal(jet);
  return normal ? Principal(Forms(jet, *normal)).k_max : 0.0;
}

// Where it bends most first: what is found there leaves the others one look each.
void SortByBend(const Surface& surface, std::vector<RegionSpot>& spots) {
  std::vector<std::pair<double, RegionSpot>> bends;
  for (const RegionSpot& spot : spots) bends.emplace_back(Bend(surface, spot), spot);
  std::stable_sort(bends.begin(), bends.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t i = 0; i < spots.size(); ++i) spots[i] = bends[i].second;
}

// Radius of the largest ball that reaches all of a region, at most params.radius; 0 where it would be so
// small that the tolerance decides. First the places given, then ever closer around the worst.
double BallForAll(const Surface& surface, const std::vector<RegionSpot>& spots, const RegionParams& params,
                  const RunContext& run, RegionSpots& more) {
  double radius = params.radius;
  const double least = LeastBall(ReachGive(params.tolerance));
  std::optional<RegionSpot> worst;
  const auto look = [&](const std::vector<RegionSpot>& at) {
    for (const RegionSpot& spot : at) {
      if (run.Cancelled() || radius <= least) return;
      const SurfaceJet jet = JetAt(surface, spot);
      const auto normal = UpwardNormal(jet);
      if (!normal) continue;
      const double own = LargestFreeRadius(surface, jet.p, *normal, radius, ReachGive(params.tolerance));
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
  RegionSpots places(surface, meshes, triangles);
  std::vector<RegionSpot> spots = places.Spread(kLooked);
  const auto deepest = [&](const std::vector<RegionSpot>& of) {
    std::vector<Vec3> points, normals;
    for (const RegionSpot& spot : of) {
      const SurfaceJet jet = JetAt(surface, spot);
      points.push_back(jet.p);
      normals.push_back(UpwardNormal(jet).value_or(Vec3::Zero()));
    }
    const Deepest found = reach.DeepestLeftover(points, normals, run);
    region.deepest_leftover = std::max(region.deepest_leftover, found.leftover);
    return of[found.place];
  };
  const RegionSpot worst = deepest(spots);
  if (run.Cancelled()) return;
  deepest(places.Around(worst, kNear * params.radius, kDeeper));
  if (region.reason != UnreachableReason::kConcave) return;
  SortByBend(surface, spots);
  region.largest_tool_diameter = 2.0 * BallForAll(surface, spots, params, run, places);
}

}  // namespace patchmill
