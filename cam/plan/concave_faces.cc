#include "cam/plan/concave_faces.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/status.h"
#include "core/surface/concave_radius.h"

namespace patchmill {
namespace {

constexpr double kSameRadius = 1e-3;  // share of it

}  // namespace

absl::StatusOr<std::vector<ConcaveFaces>> GroupConcaveFaces(const Surface& surface,
                                                            const std::vector<FaceFigures>& figures,
                                                            const RunContext& run) {
  const std::vector<ModelFace>& faces = surface.network.model.faces;
  if (faces.empty()) return std::vector<ConcaveFaces>();
  PM_ASSIGN_OR_RETURN(const std::vector<ConcaveSpot> spots, ConcaveRadiiOfFaces(surface, run));
  std::vector<FaceId> order;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!faces[f].skipped && std::isfinite(spots[f].radius)) order.emplace_back(f);
  }
  const auto key = [&](FaceId id) {
    return std::tuple(faces[id.index()].kind, spots[id.index()].radius, id);
  };
  std::sort(order.begin(), order.end(), [&](FaceId a, FaceId b) { return key(a) < key(b); });
  std::vector<ConcaveFaces> groups;
  for (const FaceId id : order) {
    const SurfaceKind kind = faces[id.index()].kind;
    const double radius = spots[id.index()].radius;
    const bool joins =
        !groups.empty() && groups.back().kind == kind && radius <= (1.0 + kSameRadius) * groups.back().radius;
    if (!joins) groups.push_back({kind, radius, {}, 0.0});
    groups.back().faces.push_back(id);
    groups.back().area += figures[id.index()].area;
  }
  return groups;
}

}  // namespace patchmill
