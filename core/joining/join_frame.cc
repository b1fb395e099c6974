#include "core/joining/join_frame.h"

#include "core/base/index.h"

namespace patchmill {
int JoinFrame::CornerAt(const FaceSide& s, bool start) const {
  const int n = SideCount(network.faces[At(s.face)]);
  return table.Forward(s, network) == start ? s.side : (s.side + 1) % n;
}

const CornerNormal& JoinFrame::CornerNormalAt(const FaceSide& s, bool start) const {
  return normals[At(s.face)][At(CornerAt(s, start))];
}

Vec3 JoinFrame::Outgoing(const std::vector<JoinedEdge>& edges, const FaceSide& s, bool first) const {
  const HermiteCurve ends = HermiteOf(edges[At(table.face_edges[At(s.face)][At(s.side)])].curve);
  return table.Forward(s, network) == first ? ends.d0 : Vec3(-ends.d1);
}

Vec3 JoinFrame::Beside(const std::vector<JoinedEdge>& edges, const FaceSide& s, bool start) const {
  const int n = SideCount(network.faces[At(s.face)]);
  const bool first = table.Forward(s, network) == start;  // at the side's own first corner
  return Outgoing(edges, {s.face, first ? (s.side + n - 1) % n : (s.side + 1) % n}, !first);
}

Where JoinFrame::Place(const JoinedEdge& edge) const {
  return edge.topology.given ? findings.AtEdge(*edge.topology.given) : findings.AtVertex(edge.topology.start);
}

}  // namespace patchmill
