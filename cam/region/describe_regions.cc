#include "cam/region/describe_regions.h"

#include <algorithm>

#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

Vec2 Corner(const SplitMesh& mesh, std::size_t triangle, std::size_t k) {
  const ZeroVertex& vertex = mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle].vertex[k])];
  return {vertex.u, vertex.v};
}

Vec2 Centroid(const SplitMesh& mesh, std::size_t triangle) {
  return (Corner(mesh, triangle, 0) + Corner(mesh, triangle, 1) + Corner(mesh, triangle, 2)) / 3.0;
}

}  // namespace

// The middle of the largest triangle of each is the point inside.
void PlaceRegions(const Surface& surface, const std::vector<SplitMesh>& meshes,
                  const std::vector<std::vector<int>>& region_of, std::vector<Region>& regions) {
  std::vector<TriangleRef> largest(regions.size());
  std::vector<double> area(regions.size(), -1.0);
  for (Region& region : regions) {
    region.z_min = kInfinity;
    region.z_max = -kInfinity;
  }
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    const SplitMesh& mesh = meshes[piece];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto id = static_cast<std::size_t>(region_of[piece][t]);
      for (const int vertex : mesh.triangles[t].vertex) {
        const double z = mesh.vertices[static_cast<std::size_t>(vertex)].p.z();
        regions[id].z_min = std::min(regions[id].z_min, z);
        regions[id].z_max = std::max(regions[id].z_max, z);
      }
      if (mesh.triangles[t].area > area[id]) {
        area[id] = mesh.triangles[t].area;
        largest[id] = {piece, t};
      }
    }
  }
  for (std::size_t id = 0; id < regions.size(); ++id) {
    const TriangleRef& t = largest[id];
    const Vec2 q = Centroid(meshes[t.piece], t.triangle);
    regions[id].inside = Position(surface.pieces[t.piece], q.x(), q.y());
  }
}

void ProbeRegion(const Surface& surface, const std::vector<SplitMesh>& meshes, const ReachTest& reach,
                 const RegionParams& params, const std::vector<TriangleRef>& triangles, const RunContext& run,
                 Region& region) {
  constexpr std::size_t kLooked = 200, kSpread = 8, kBent = 4;
  struct Concave {
    double bends = 0.0;  // the larger principal curvature, > 0 concave
    Vec3 p, normal;
  };
  std::vector<Concave> places;
  std::vector<Vec3> looked;
  const std::size_t look = std::max<std::size_t>(1, triangles.size() / kLooked);
  const auto look_at = [&](const Piece& piece, const Vec2& q) {
    const SurfaceJet jet = Evaluate(piece, q.x(), q.y());
    looked.push_back(jet.p);
    const auto normal = UpwardNormal(jet);
    if (region.reason == UnreachableReason::kConcave && normal)
      places.push_back({Principal(Forms(jet, *normal)).k_max, jet.p, *normal});
  };
  for (std::size_t i = 0; i < triangles.size(); i += look) {
    const Piece& piece = surface.pieces[triangles[i].piece];
    const SplitMesh& mesh = meshes[triangles[i].piece];
    const Vec2 middle = Centroid(mesh, triangles[i].triangle);
    look_at(piece, middle);
    if (4 * triangles.size() > kLooked) continue;  // few large ones: between middle and corners too
    for (const std::size_t k : {0, 1, 2})
      look_at(piece, 0.5 * (middle + Corner(mesh, triangles[i].triangle, k)));
  }
  region.deepest_leftover = reach.DeepestLeftover(looked, run);
  if (region.reason != UnreachableReason::kConcave) return;
  // The ball that reaches some places spread over the region, and those where it bends most.
  double largest = params.radius;
  const auto probe = [&](const Concave& at) {
    largest = std::min(largest, LargestFreeRadius(surface, at.p, at.normal, largest, params.tolerance));
  };
  const std::size_t spread = std::max<std::size_t>(1, places.size() / kSpread);
  for (std::size_t i = 0; i < places.size(); i += spread) probe(places[i]);
  std::stable_sort(places.begin(), places.end(),
                   [](const Concave& a, const Concave& b) { return a.bends > b.bends; });
  for (std::size_t i = 0; i < std::min(kBent, places.size()); ++i) probe(places[i]);
  region.largest_tool_diameter = 2.0 * largest;
}

std::vector<std::vector<TriangleRef>> UnreachableTriangles(const std::vector<SplitMesh>& meshes,
                                                           const std::vector<std::vector<int>>& region_of,
                                                           const std::vector<Region>& regions) {
  std::vector<std::vector<TriangleRef>> unreachable(regions.size());
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    for (std::size_t t = 0; t < meshes[piece].triangles.size(); ++t) {
      const auto id = static_cast<std::size_t>(region_of[piece][t]);
      if (regions[id].kind == RegionKind::kUnreachable) unreachable[id].push_back({piece, t});
    }
  }
  return unreachable;
}

}  // namespace patchmill
