#include "cam/region/figures/describe_regions.h"

#include <algorithm>

namespace patchmill {

// The point inside is the middle of the region's largest triangle whose middle has the region's label. If
// there is none, it is the middle of the largest triangle.
std::vector<RegionPlace> PlaceRegions(const SplitSurface& split, const TriangleRegions& triangles,
                                      const RegionMap& map) {
  struct Inside {
    TriangleRef triangle;
    bool labelled = false;
    double area = -1.0;
  };
  std::vector<Inside> inside(triangles.region_count);
  std::vector<RegionPlace> places(triangles.region_count);
  for (std::size_t piece = 0; piece < split.meshes.size(); ++piece) {
    const SplitMesh& mesh = split.meshes[piece];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const RegionId id = triangles.region_of[piece][t];
      RegionPlace& place = places[id.index()];
      for (const int vertex : mesh.triangles[t].vertex) {
        const double z = mesh.vertices[static_cast<std::size_t>(vertex)].p.z();
        place.z_min = std::min(place.z_min, z);
        place.z_max = std::max(place.z_max, z);
      }
      Inside& best = inside[id.index()];
      const double area = mesh.triangles[t].area;
      if (best.labelled && area <= best.area) continue;
      const Vec2 q = MiddleOf(mesh, t);
      const bool labelled = map.At({PieceId(piece), q.x(), q.y(), Vec3::Zero()}) == id;
      if (labelled > best.labelled || (labelled == best.labelled && area > best.area))
        best = {{piece, t}, labelled, area};
    }
  }
  for (std::size_t id = 0; id < places.size(); ++id) {
    const TriangleRef& t = inside[id].triangle;
    const Vec2 q = MiddleOf(split.meshes[t.piece], t.triangle);
    places[id].inside = Position(split.surface->pieces[t.piece], q.x(), q.y());
  }
  return places;
}

std::vector<std::vector<TriangleRef>> UnreachableTriangles(const TriangleRegions& triangles,
                                                           const std::vector<Region>& regions) {
  std::vector<std::vector<TriangleRef>> unreachable(regions.size());
  for (std::size_t piece = 0; piece < triangles.region_of.size(); ++piece) {
    const std::vector<RegionId>& ids = triangles.region_of[piece];
    for (std::size_t t = 0; t < ids.size(); ++t) {
      const std::size_t id = ids[t].index();
      if (regions[id].kind == RegionKind::kUnreachable) unreachable[id].push_back({piece, t});
    }
  }
  return unreachable;
}

// The patches come in rising order, because pieces are sorted by patch.
std::vector<std::vector<PatchId>> PatchesOfRegions(const Surface& surface, const TriangleRegions& triangles) {
  std::vector<std::vector<PatchId>> patches(triangles.region_count);
  for (std::size_t piece = 0; piece < triangles.region_of.size(); ++piece) {
    const PatchId patch = surface.pieces[piece].patch;
    for (const RegionId id : triangles.region_of[piece]) {
      std::vector<PatchId>& own = patches[id.index()];
      if (own.empty() || own.back() != patch) own.push_back(patch);
    }
  }
  return patches;
}

}  // namespace patchmill
