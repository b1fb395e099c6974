#include "cam/region/figures/describe_regions.h"

#include <algorithm>

namespace patchmill {
// The point inside is the middle of the region's largest triangle whose middle has the region's label. If
// there is none, it is the middle of the largest triangle.
void PlaceRegions(const Surface& surface, const std::vector<SplitMesh>& meshes,
                  const std::vector<std::vector<RegionId>>& region_of, const RegionMap& map,
                  std::vector<Region>& regions) {
  struct Inside {
    TriangleRef triangle;
    bool labelled = false;
    double area = -1.0;
  };
  std::vector<Inside> inside(regions.size());
  for (Region& region : regions) {
    region.z_min = kInfinity;
    region.z_max = -kInfinity;
  }
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    const SplitMesh& mesh = meshes[piece];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::size_t id = region_of[piece][t].index();
      for (const int vertex : mesh.triangles[t].vertex) {
        const double z = mesh.vertices[static_cast<std::size_t>(vertex)].p.z();
        regions[id].z_min = std::min(regions[id].z_min, z);
        regions[id].z_max = std::max(regions[id].z_max, z);
      }
      Inside& best = inside[id];
      const double area = mesh.triangles[t].area;
      if (best.labelled && area <= best.area) continue;
      const Vec2 q = MiddleOf(mesh, t);
      const bool labelled = map.At({PieceId(piece), q.x(), q.y(), Vec3::Zero()}) == RegionId(id);
      if (labelled > best.labelled || (labelled == best.labelled && area > best.area))
        best = {{piece, t}, labelled, area};
    }
  }
  for (std::size_t id = 0; id < regions.size(); ++id) {
    const TriangleRef& t = inside[id].triangle;
    const Vec2 q = MiddleOf(meshes[t.piece], t.triangle);
    regions[id].inside = Position(surface.pieces[t.piece], q.x(), q.y());
  }
}

std::vector<std::vector<TriangleRef>> UnreachableTriangles(
    const std::vector<SplitMesh>& meshes, const std::vector<std::vector<RegionId>>& region_of,
    const std::vector<Region>& regions) {
  std::vector<std::vector<TriangleRef>> unreachable(regions.size());
  for (std::size_t piece = 0; piece < meshes.size(); ++piece) {
    for (std::size_t t = 0; t < meshes[piece].triangles.size(); ++t) {
      const std::size_t id = region_of[piece][t].index();
      if (regions[id].kind == RegionKind::kUnreachable) unreachable[id].push_back({piece, t});
    }
  }
  return unreachable;
}

}  // namespace patchmill
