#include "core/joining/cross_tangents.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/joining/face_push.h"
#include "core/joining/network_findings.h"
#include "core/joining/tangent_plane.h"

namespace patchmill {
namespace {

bool IsHosaka(const JoinFrame& frame, const FaceSide& s) {
  return frame.network.faces[At(s.face)].scheme == PatchScheme::kHosaka;
}

// The twists that a face wants along one of its edges, with the cross tangents `across`: given ones replace
// `wished`, pushes add to them.
EndVectors Wish(const JoinFrame& frame, const FaceSide& s, const HermiteCurve& edge, const EndVectors& across,
                EndVectors wished) {
  const NetworkFace& face = frame.network.faces[At(s.face)];
  const TableEdge& ends = frame.table.edges[At(frame.table.face_edges[At(s.face)][At(s.side)])];
  for (const SideTwists& twists : face.twists) {
    const bool forward = twists.start == ends.start && twists.end == ends.end;
    if (!forward && !(twists.start == ends.end && twists.end == ends.start)) continue;
    const auto &first = forward ? twists.at_start : twists.at_end,
               &last = forward ? twists.at_end : twists.at_start;
    if (first) wished.start = *first;
    if (last) wished.end = *last;
  }
  const bool forward = frame.table.Forward(s, frame.network);  // then the face lies to the left of its edge
  for (const FacePush& push : face.pushes) {
    EdgePlace place = PlaceBeside(push, SideCount(face), s.side);
    if (!forward) place.along = 1.0 - place.along;
    const EndVectors pushed =
        PushTwists({edge.d0, edge.d1}, across, place, forward ? -push.amount : push.amount);
    wished.start += pushed.start;
    wished.end += pushed.end;
  }
  return wished;
}

// The factors of an edge. If it has none, the reason is reported.
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

// The tangent with the degree of the edge and the breaks of both.
BezierChain Along(const BezierChain& edge, const BezierChain& tangent) {
  const BezierChain raised = Elevated(tangent, edge.degree);
  if (edge.spans() == 1) return raised;
  return CutAt(raised, CommonBreaks({edge, raised}));
}

// The angle (rad) by which the faces bend across a break where the edge's second derivative jumps, taken with
// the largest |l| of [joining (4)]; the largest of all breaks.
double BendAtBreaks(const BezierChain& edge, const JoinFactors& factors) {
  const double l = std::max(std::abs(factors.l[0]), std::abs(factors.l[1]));
  double worst = 0.0;
  for (int k = 1; k < edge.spans(); ++k) {
    const auto jets = JetsAtBreak(edge, k);
    // The tangents get the additional term l (C - H)' / 2, weighted by phi1 <= 4/27.
    worst = std::max(worst, 2.0 / 27.0 * l * (jets[1].dd - jets[0].dd).norm() / jets[0].d.norm());
  }
  return worst;
}

bool SmoothEnough(const JoinFrame& frame, const JoinedEdge& edge, const JoinFactors& factors) {
  const double bend = BendAtBreaks(edge.curve, factors);
  if (bend <= kMaxTangentTilt) return true;
  frame.findings.Error("UNSUPPORTED_CURVE", frame.Place(edge),
                       fmt::format("is smooth and has a curve of {} spans whose second derivative jumps: its "
                                   "faces would bend by up to "
                                   "{:.3g} rad; insert vertices at its knots, or make it a crease",
                                   edge.curve.spans(), bend));
  return false;
}

// Checks that two tangents lie in one plane with the edge everywhere, as they do at its ends.
void CheckOnePlane(const JoinFrame& frame, const JoinedEdge& edge, const BezierChain& a,
                   const BezierChain& b) {
  // det(C', a, b) is a polynomial on each span, so a number of places above its degree is enough.
  const std::vector<double> breaks = CommonBreaks({edge.curve, a, b});
  const int places = edge.curve.degree + a.degree + b.degree + 1;
  double worst = 0.0;
  for (std::size_t k = 1; k < breaks.size(); ++k) {
    for (int i = 1; i <= places; ++i) {
      const double t = breaks[k - 1] + (breaks[k] - breaks[k - 1]) * i / (places + 1);
      const Vec3 c = Evaluate(edge.curve, t).d;
      const Vec3 m = c.cross(Evaluate(a, t).p).normalized(), n = c.cross(Evaluate(b, t).p).normalized();
      worst = std::max(worst, m.cross(n).norm());
    }
  }
  if (worst <= kMaxTangentTilt) return;
  frame.findings.Error(
      "HOSAKA_RATIO", frame.Place(edge),
      fmt::format(
          "from vertex {} to {} has Hosaka faces whose tangent planes part by {:.3g} rad between its ends: "
          "the edges that cross it there must continue with one ratio of lengths; give their tangents, make "
          "it a crease, or let one face be a Brown quad, which follows",
          edge.topology.start, edge.topology.end, std::asin(std::min(1.0, worst))));
}

// A face that follows another one along an edge must not have twists there.
void RefuseTwists(const JoinFrame& frame, const TableEdge& edge, int face, int leader) {
  const auto ends = std::minmax(edge.start, edge.end);
  const auto here = [&](const SideTwists& w) { return std::minmax(w.start, w.end) == ends; };
  if (std::ranges::none_of(frame.network.faces[At(face)].twists, here)) return;
  frame.findings.Error(
      "INVALID_TWIST", frame.findings.AtFace(face),
      fmt::format("has twists from vertex {} to {}, where it follows faces[{}]; leave them out", ends.first,
                  ends.second, leader));
}

// Joins the faces of a smooth edge of which at least one is a Hosaka face, whose tangents are fixed.
void JoinHosaka(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const CrossTangents& t,
                const JoinFactors& factors, JoinedEdge& edge) {
  const auto& sides = edge.topology.faces;
  const bool first = IsHosaka(frame, sides[0]);
  if (first && IsHosaka(frame, sides[1])) {
    for (const FaceSide& s : sides) edge.tangents.push_back(Along(edge.curve, LoneTangent(frame, edges, s)));
    CheckOnePlane(frame, edge, edge.tangents[0], edge.tangents[1]);
    return;
  }
  JoinFactors turned = factors;
  if (!first) std::swap(turned.h, turned.k);
  RefuseTwists(frame, edge.topology, sides[first ? 1 : 0].face, sides[first ? 0 : 1].face);
  const BezierChain leading = LoneTangent(frame, edges, sides[first ? 0 : 1]);
  BezierChain following =
      FollowingTangent(edge.curve, leading, turned, first ? t.b0 : t.a0, first ? t.b1 : t.a1);
  edge.tangents = {Along(edge.curve, leading), std::move(following)};
  if (!first) std::swap(edge.tangents[0], edge.tangents[1]);
}

// Joins both faces of a smooth edge.
void Join(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, JoinedEdge& edge) {
  const auto& sides = edge.topology.faces;
  const CrossTangents t{frame.Beside(edges, sides[0], true), frame.Beside(edges, sides[0], false),
                        frame.Beside(edges, sides[1], true), frame.Beside(edges, sides[1], false)};
  const auto factors = Factors(frame, edge, t);
  if (!factors || !SmoothEnough(frame, edge, *factors)) return;
  if (IsHosaka(frame, sides[0]) || IsHosaka(frame, sides[1]))
    return JoinHosaka(frame, edges, t, *factors, edge);
  const HermiteCurve cubic = HermiteOf(edge.curve);
  EdgeTwists twists = WishedTwists(t);
  const EndVectors first = Wish(frame, sides[0], cubic, {t.a0, t.a1}, {twists.a0, twists.a1});
  const EndVectors second = Wish(frame, sides[1], cubic, {t.b0, t.b1}, {twists.b0, twists.b1});
  twists = {first.start, first.end, second.start, second.end};
  twists = NearestTwists(cubic, t, *factors, twists);
  const BezierChain correction = CorrectionFor(edge.curve, *factors);
  for (const bool a : {true, false}) {
    BezierChain tangent =
        Along(edge.curve, AsChain(a ? CrossBoundaryTangent(t.a0, twists.a0, t.a1, twists.a1)
                                    : CrossBoundaryTangent(t.b0, twists.b0, t.b1, twists.b1)));
    for (std::size_t i = 0; i < tangent.points.size(); ++i) tangent.points[i] += correction.points[i];
    edge.tangents.push_back(std::move(tangent));
  }
}

// Makes the face along a part follow the face along the whole edge.
void Follow(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, JoinedEdge& edge) {
  const JoinedEdge& whole = edges[At(edge.topology.part->whole)];
  const BezierChain leading = Part(LoneTangent(frame, edges, whole.topology.faces[0]),
                                   edge.topology.part->from, edge.topology.part->to);
  const FaceSide& side = edge.topology.faces[0];
  RefuseTwists(frame, edge.topology, side.face, whole.topology.faces[0].face);
  const CrossTangents t{leading.points.front(), leading.points.back(), frame.Beside(edges, side, true),
                        frame.Beside(edges, side, false)};
  const auto factors = Factors(frame, edge, t);
  if (!factors || !SmoothEnough(frame, edge, *factors)) return;
  if (IsHosaka(frame, side)) {
    edge.tangents = {Along(edge.curve, LoneTangent(frame, edges, side))};
    CheckOnePlane(frame, edge, leading, edge.tangents[0]);
    return;
  }
  edge.tangents = {FollowingTangent(edge.curve, leading, *factors, t.b0, t.b1)};
}

// [joining (12)]: a smooth step from one end to the other. With vertices on the edge there is one step
// between neighbouring places, and f(v_j) = v_j.
BezierChain HosakaTangent(const JoinedEdge& edge, const std::vector<JoinedEdge>& edges, const Vec3& a0,
                          const Vec3& a1) {
  BezierChain tangent{3, {0.0}, {a0}};
  std::vector<double> steps = HosakaBreaks(edge, edges);
  steps.push_back(1.0);
  for (const double v : steps) {
    const Vec3 before = tangent.points.back(), after = v == 1.0 ? a1 : Vec3(a0 + v * (a1 - a0));
    tangent.breaks.push_back(v);
    tangent.points.insert(tangent.points.end(), {before, after, after});
  }
  return tangent;
}

}  // namespace

bool CubicAcross(const NetworkFace& face) {
  return face.scheme == PatchScheme::kHosaka || !face.pushes.empty() || !face.twists.empty();
}

std::vector<double> HosakaBreaks(const JoinedEdge& edge, const std::vector<JoinedEdge>& edges) {
  std::vector<double> breaks;
  if (edge.kind != EdgeKind::kLeading) return breaks;
  for (const int p : edge.topology.parts) {
    for (const double at : {edges[At(p)].topology.part->from, edges[At(p)].topology.part->to}) {
      if (at > 0.0 && at < 1.0 && (breaks.empty() || at > breaks.back())) breaks.push_back(at);
    }
  }
  return breaks;
}

BezierChain LoneTangent(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const FaceSide& side) {
  const Vec3 a0 = frame.Beside(edges, side, true), a1 = frame.Beside(edges, side, false);
  const JoinedEdge& edge = edges[At(frame.table.face_edges[At(side.face)][At(side.side)])];
  if (IsHosaka(frame, side)) return HosakaTangent(edge, edges, a0, a1);
  if (!CubicAcross(frame.network.faces[At(side.face)])) return AsChain({{a0, a1}});
  const EdgeTwists twists = WishedTwists({a0, a1, a0, a1});
  const EndVectors wished = Wish(frame, side, HermiteOf(edge.curve), {a0, a1}, {twists.a0, twists.a1});
  return AsChain(CrossBoundaryTangent(a0, wished.start, a1, wished.end));
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
        edge.tangents.push_back(Along(edge.curve, LoneTangent(frame, edges, side)));
      }
    }
  }
}

}  // namespace patchmill
