#include "core/joining/t_places.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/joining/cross_tangents.h"
#include "core/joining/t_vertices.h"

namespace patchmill {
void EstimateTPlaces(const EdgeTable& table, CurveNetwork& network) {
  for (const TVertex& t : table.t_vertices) {
    const TableEdge& edge = table.edges[At(t.edge)];
    network.vertices[At(t.vertex)].position = (1.0 - t.at) * network.vertices[At(edge.start)].position +
                                              t.at * network.vertices[At(edge.end)].position;
  }
}

void PlaceTVertex(const std::vector<JoinedEdge>& edges, const TVertex& t, JoinFrame& frame) {
  const JoinedEdge& whole = edges[At(t.edge)];
  const CurveJet jet = Evaluate(whole.curve, t.at);
  NetworkVertex& vertex = frame.network.vertices[At(t.vertex)];
  vertex.position = jet.p;
  const FaceSide& leader = whole.topology.faces[0];
  const Vec3 across = Evaluate(LoneTangent(frame, edges, leader), t.at).p;
  Vec3 normal = jet.d.cross(across);
  if (!(normal.norm() > kMinTangentSine * jet.d.norm() * across.norm())) {
    frame.findings.Error("PARALLEL_TANGENTS", frame.findings.AtVertex(t.vertex),
                         fmt::format("lies where faces[{}] has no tangent plane", leader.face));
    return;
  }
  normal.normalize();
  const Vec3 along = jet.d.normalized();
  std::vector<bool> led(At(frame.table.group_count));
  for (const FaceSide& c : CornersAlong(frame.network, frame.table, t)) {
    led[At(frame.table.group[At(c.face)][At(c.side)])] = true;
  }
  // Sets every corner of these groups, also of faces that touch the edge in this point only.
  for (const FaceSide& c : t.corners) {
    if (!led[At(frame.table.group[At(c.face)][At(c.side)])]) continue;
    CornerNormal& corner = frame.normals[At(c.face)][At(c.side)];
    if (!whole.topology.crease) {
      corner = {normal, false};
    } else if (vertex.normals.empty()) {
      corner.unit = (corner.unit - along * along.dot(corner.unit)).normalized();
    }
  }
}

}  // namespace patchmill
