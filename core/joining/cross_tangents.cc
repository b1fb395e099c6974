#include "core/joining/cross_tangents.h"

#include <fmt/format.h>

#include "core/joining/face_push.h"
#include "core/joining/tangent_plane.h"

namespace patchmill {
namespace {

std::size_t At(int i) { return static_cast<std::size_t>(i); }

// Adds what a pushed face wishes for one of its edges to its twists.
void Push(const JoinFrame& frame, const FaceSide& s, const HermiteCurve& edge, const Vec3& b0, const Vec3& b1,
          Vec3& w0, Vec3& w1) {
  const NetworkFace& face = frame.network.faces[At(s.face)];
  const bool forward = frame.table.Forward(s, frame.network);  // then the face lies to the left of its edge
  for (const FacePush& push : face.pushes) {
    EdgePlace place = PlaceBeside(push, SideCount(face), s.side);
    if (!forward) place.along = 1.0 - place.along;
    PushTwists(edge.d0, edge.d1, b0, b1, place, forward ? -push.amount : push.amount, w0, w1);
  }
}

// Finds fault with an edge, if there is one.
std::optional<JoinFactors> Factors(const JoinFrame& frame, const JoinedEdge& edge, const CrossTangents& t) {
  const HermiteCurve cubic = HermiteOf(edge.curve);
  const FaceSide& side = edge.topology.faces[0];
  const auto factors =
      FactorsAlong(cubic.d0, cubic.d1, t, frame.NormalAt(side, true), frame.NormalAt(side, false));
  const auto* fault = std::get_if<JoinFault>(&factors);
  if (fault == nullptr) return std::get<JoinFactors>(factors);
  const bool folded = *fault == JoinFault::kFolded;
  frame.findings.Error(
      folded ? "FOLDED_EDGE" : "PARALLEL_TANGENTS", frame.Place(edge),
      fmt::format("from vertex {} to {}: {}", edge.topology.start, edge.topology.end,
                  folded ? "both faces leave it to the same side; make it a crease or move a normal"
                         : "an edge next to it leaves an end in line with it"));
  return std::nullopt;
}

// Both faces of a smooth edge.
void Join(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, JoinedEdge& edge) {
  const auto& sides = edge.topology.faces;
  const CrossTangents t{frame.Beside(edges, sides[0], true), frame.Beside(edges, sides[0], false),
                        frame.Beside(edges, sides[1], true), frame.Beside(edges, sides[1], false)};
  const HermiteCurve cubic = HermiteOf(edge.curve);
  EdgeTwists twists = WishedTwists(t);
  Push(frame, sides[0], cubic, t.a0, t.a1, twists.a0, twists.a1);
  Push(frame, sides[1], cubic, t.b0, t.b1, twists.b0, twists.b1);
  const auto factors = Factors(frame, edge, t);
  if (!factors) return;
  twists = NearestTwists(cubic, t, *factors, twists);
  const BezierCurve correction = CorrectionFor(edge.curve, *factors);
  for (const bool a : {true, false}) {
    BezierCurve tangent = Elevated(a ? CrossBoundaryTangent(t.a0, twists.a0, t.a1, twists.a1)
                                     : CrossBoundaryTangent(t.b0, twists.b0, t.b1, twists.b1),
                                   edge.curve.degree());
    for (std::size_t i = 0; i < tangent.points.size(); ++i) tangent.points[i] += correction.points[i];
    edge.tangents.push_back(std::move(tangent));
  }
}

// The face along a part follows the one along the whole edge.
void Follow(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, JoinedEdge& edge) {
  const JoinedEdge& whole = edges[At(edge.topology.part->whole)];
  const BezierCurve leading = Part(LoneTangent(frame, edges, whole.topology.faces[0]),
                                   edge.topology.part->from, edge.topology.part->to);
  const FaceSide& side = edge.topology.faces[0];
  const CrossTangents t{leading.points.front(), leading.points.back(), frame.Beside(edges, side, true),
                        frame.Beside(edges, side, false)};
  if (const auto factors = Factors(frame, edge, t)) {
    edge.tangents = {FollowingTangent(edge.curve, leading, *factors, t.b0, t.b1)};
  }
}

}  // namespace

BezierCurve LoneTangent(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const FaceSide& side) {
  const Vec3 a0 = frame.Beside(edges, side, true), a1 = frame.Beside(edges, side, false);
  if (frame.network.faces[At(side.face)].pushes.empty()) return {{a0, a1}};
  const BezierCurve& curve = edges[At(frame.table.face_edges[At(side.face)][At(side.side)])].curve;
  EdgeTwists twists = WishedTwists({a0, a1, a0, a1});
  Push(frame, side, HermiteOf(curve), a0, a1, twists.a0, twists.a1);
  return CrossBoundaryTangent(a0, twists.a0, a1, twists.a1);
}

void AddCrossTangents(const JoinFrame& frame, std::vector<JoinedEdge>& edges, const RunContext& run) {
  for (JoinedEdge& edge : edges) {
    if (run.Cancelled()) return;
    if (edge.kind == EdgeKind::kSmooth) {
      Join(frame, edges, edge);
    } else if (edge.kind == EdgeKind::kFollowing) {
      Follow(frame, edges, edge);
    } else {
      for (const FaceSide& side : edge.topology.faces) {
        edge.tangents.push_back(Elevated(LoneTangent(frame, edges, side), edge.curve.degree()));
      }
    }
  }
}

}  // namespace patchmill
