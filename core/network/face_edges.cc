#include "core/network/face_edges.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/index.h"
#include "core/network/edge_angles.h"

namespace patchmill {
namespace {

std::optional<FaceId> FaceOf(const PatchModel& model, PatchId patch) {
  return model.patches[patch.index()].face;
}

// > 0 where the edge sticks out, < 0 in an inner corner, 0 where the normals of its faces look to different
// sides of the sheet. Taken in the middle of the edge.
double Convexity(const EdgeCurves& curves, int e, int other, bool reversed) {
  const PatchEdge self = curves.edge(e), neighbor = curves.edge(other);
  // Two patches of one orientation pass their edge in opposite directions.
  if ((RunsAroundPatch(self.edge) == RunsAroundPatch(neighbor.edge)) != reversed) return 0.0;
  const auto own = PatchNormal(curves.shape(e), EdgeParameters(curves.shape(e), self.edge, 0.5));
  const double t = ClosestOnEdge(curves, other, curves.Point(e, 0.5)).t;
  const auto beside = PatchNormal(curves.shape(other), EdgeParameters(curves.shape(other), neighbor.edge, t));
  if (!own || !beside) return 0.0;
  const Vec3 along = curves.Point(e, 0.51) - curves.Point(e, 0.49);
  return own->cross(*beside).dot(along) * (RunsAroundPatch(self.edge) ? 1.0 : -1.0);
}

}  // namespace

bool IsOfFaces(const PatchModel& model, const EdgeLink& link) {
  return FaceOf(model, link.self.patch) && (!link.neighbor || FaceOf(model, link.neighbor->patch));
}

bool IsInsideFace(const PatchModel& model, const EdgeLink& link) {
  const std::optional<FaceId> face = FaceOf(model, link.self.patch);
  return face && link.neighbor && FaceOf(model, link.neighbor->patch) == face;
}

FaceEdges EdgesOfFaces(const PatchModel& model, const EdgeCurves& curves, const FaceJoints& joints,
                       const std::vector<bool>& left_out) {
  std::map<FaceId, OpenFaceEdges> open;
  std::map<std::pair<FaceId, FaceId>, FaceCrease> creases;
  // Edge `e` lies along edge `f` of another face, all of it.
  const auto meet = [&](int e, int f, bool reversed, double angle) {
    const std::optional<FaceId> one = FaceOf(model, curves.edge(e).patch);
    const std::optional<FaceId> two = FaceOf(model, curves.edge(f).patch);
    if (!one || !two || one == two || angle <= kTangentBreak) return;
    const std::pair<FaceId, FaceId> pair = std::minmax(*one, *two);
    FaceCrease& sum =
        creases.try_emplace(pair, FaceCrease{pair.first, pair.second, e, 0.0, 0.0}).first->second;
    if (angle > sum.max_angle) {
      sum.sharpest = e;
      sum.max_angle = angle;
    }
    const double length = curves.length(e), convexity = Convexity(curves, e, f, reversed);
    sum.length += length;
    if (convexity > 0.0) sum.convex_length += length;
    if (convexity < 0.0) sum.concave_length += length;
  };
  const auto index = [&](const PatchEdge& edge) {
    return curves.first_edge()[edge.patch.index()] + edge.edge;
  };
  for (int e = 0; e < curves.count(); ++e) {
    const EdgeLink& link = joints.edges[At(e)];
    if (!IsOfFaces(model, link) || link.collapsed || left_out[At(e)]) continue;
    if (link.neighbor) {
      const FaceId face = *FaceOf(model, link.self.patch), other = *FaceOf(model, link.neighbor->patch);
      if (face < other) meet(e, index(*link.neighbor), link.reversed, link.max_angle);
    } else if (!link.on_t_junction) {
      const FaceId face = *FaceOf(model, link.self.patch);
      const double length = curves.length(e);
      OpenFaceEdges& sum = open.try_emplace(face, OpenFaceEdges{face, e, 0, 0.0}).first->second;
      if (length > curves.length(sum.longest)) sum.longest = e;
      ++sum.count;
      sum.length += length;
    }
  }
  for (const PartLink& link : joints.parts) {
    const int part = index(link.part), whole = index(link.whole);
    if (left_out[At(part)] || joints.edges[At(part)].neighbor) continue;
    meet(part, whole, link.to < link.from, link.max_angle);
  }
  FaceEdges edges;
  for (const auto& [face, sum] : open) edges.open.push_back(sum);
  for (const auto& [pair, sum] : creases) edges.creases.push_back(sum);
  return edges;
}

}  // namespace patchmill
