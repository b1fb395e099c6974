#include "core/editing/surface_normals.h"

#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"

namespace patchmill {

absl::StatusOr<NetworkOnSurface> WithNormalsOf(const Surface& surface, CurveNetwork network,
                                               const RunContext& run) {
  NetworkOnSurface result;
  std::vector<double> distance(network.vertices.size(), 0.0);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, network.vertices.size(), [&](std::size_t k) {
    NetworkVertex& vertex = network.vertices[k];
    if (!vertex.position.allFinite() || vertex.on_edge) return;  // a T-junction: its edge decides
    const auto nearest = ClosestToPoint(surface, vertex.position, kInfinity, 1e-9 * surface.box.Diagonal());
    if (!nearest) return;
    distance[k] = nearest->distance;
    const auto normal = UnitNormal(Evaluate(surface, nearest->at.piece, nearest->at.u, nearest->at.v));
    if (normal && vertex.normals.empty()) vertex.normals = {{*normal, {}}};
  }));
  for (std::size_t k = 0; k < distance.size(); ++k) {
    if (result.farthest_vertex >= 0 && distance[k] <= result.max_distance) continue;
    result.max_distance = distance[k];
    result.farthest_vertex = static_cast<int>(k);
  }
  result.network = std::move(network);
  return result;
}

}  // namespace patchmill
