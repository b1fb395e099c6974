#include "core/joining/join_network.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "core/curve/edge_tangents.h"
#include "core/curve/hosaka_fit.h"
#include "core/joining/corner_normals.h"
#include "core/joining/curvature_rows.h"
#include "core/joining/face_patch.h"
#include "core/joining/face_push.h"
#include "core/joining/line_edges.h"
#include "core/joining/network_findings.h"

namespace patchmill {
namespace {

std::size_t At(int i) { return static_cast<std::size_t>(i); }

// Corner of the side's face that lies at the start (end) of the edge.
int CornerAt(const CurveNetwork& network, const EdgeTable& table, const FaceSide& s, bool start) {
  const int n = SideCount(network.faces[At(s.face)]);
  return table.Forward(s, network) == start ? s.side : (s.side + 1) % n;
}

class Joiner {
 public:
  Joiner(const CurveNetwork& network, const EdgeTable& table, Diagnostics& findings)
      : network_(network),
        table_(table),
        normals_(CornerNormals(network, table)),
        findings_(network, findings) {}

  std::vector<JoinedEdge> Edges() {
    edges_.resize(table_.edges.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      JoinedEdge& edge = edges_[e];
      edge.topology = table_.edges[e];
      edge.kind = edge.topology.faces.size() < 2 ? EdgeKind::kFree
                  : edge.topology.crease         ? EdgeKind::kCrease
                                                 : EdgeKind::kSmooth;
      MakeCurve(edge);
    }
    return std::move(edges_);
  }

  // Cross-boundary tangents of all edges, from the finished curves.
  void Tangents(std::vector<JoinedEdge>& edges) {
    for (JoinedEdge& edge : edges) {
      CrossTangents t;
      const auto& sides = edge.topology.faces;
      std::vector<std::pair<Vec3, Vec3>> ends;
      for (const FaceSide& s : sides) ends.emplace_back(Beside(edges, s, true), Beside(edges, s, false));
      std::tie(t.a0, t.a1) = ends[0];
      std::tie(t.b0, t.b1) = ends.back();
      const HermiteCurve cubic = HermiteOf(edge.curve);
      EdgeTwists twists = WishedTwists(t);
      for (std::size_t k = 0; k < sides.size(); ++k) {
        k == 0 ? Push(sides[k], cubic, t.a0, t.a1, twists.a0, twists.a1)
               : Push(sides[k], cubic, t.b0, t.b1, twists.b0, twists.b1);
      }
      BezierCurve correction{std::vector<Vec3>(At(edge.curve.degree() + 1), Vec3::Zero())};
      if (edge.kind == EdgeKind::kSmooth) {
        const auto factors =
            FactorsAlong(cubic.d0, cubic.d1, t, NormalAt(sides[0], true), NormalAt(sides[0], false));
        if (const auto* fault = std::get_if<JoinFault>(&factors)) {
          const bool folded = *fault == JoinFault::kFolded;
          findings_.Error(
              folded ? "FOLDED_EDGE" : "PARALLEL_TANGENTS", Place(edge),
              fmt::format("from vertex {} to {}: {}", edge.topology.start, edge.topology.end,
                          folded ? "both faces leave it to the same side; make it a crease or move a normal"
                                 : "an edge next to it leaves an end in line with it"));
          continue;
        }
        twists = NearestTwists(cubic, t, std::get<JoinFactors>(factors), twists);
        correction = CorrectionFor(edge.curve, std::get<JoinFactors>(factors));
      }
      for (std::size_t k = 0; k < sides.size(); ++k) {
        BezierCurve tangent = k == 0 ? CrossBoundaryTangent(t.a0, twists.a0, t.a1, twists.a1)
                                     : CrossBoundaryTangent(t.b0, twists.b0, t.b1, twists.b1);
        tangent = Elevated(std::move(tangent), edge.curve.degree());
        for (std::size_t i = 0; i < tangent.points.size(); ++i) tangent.points[i] += correction.points[i];
        edge.tangents.push_back(std::move(tangent));
      }
    }
  }

  // What a face's scheme cannot make of its edges.
  void CheckSchemes(const std::vector<JoinedEdge>& edges) {
    for (int f = 0; f < static_cast<int>(network_.faces.size()); ++f) {
      const NetworkFace& face = network_.faces[At(f)];
      int degree = 3;
      for (int s = 0; s < SideCount(face); ++s) {
        degree = std::max(degree, edges[At(table_.face_edges[At(f)][At(s)])].curve.degree());
      }
      if (const auto fault = SchemeFault(face, degree)) {
        findings_.Error("UNSUPPORTED_SCHEME", findings_.AtFace(f), *fault);
      }
    }
  }

  void Rows(std::vector<JoinedEdge>& edges) { AddCurvatureRows(network_, table_, findings_, edges); }

  PatchModel Patches(const std::vector<JoinedEdge>& edges) {
    PatchModel model;
    model.join_tolerance = network_.join_tolerance;
    for (int f = 0; f < static_cast<int>(network_.faces.size()); ++f) {
      const NetworkFace& face = network_.faces[At(f)];
      FaceBoundary boundary;
      boundary.sides = SideCount(face);
      for (int s = 0; s < boundary.sides; ++s) {
        const JoinedEdge& edge = edges[At(table_.face_edges[At(f)][At(s)])];
        std::size_t k = 0;
        while (edge.topology.faces[k].face != f || edge.topology.faces[k].side != s) ++k;
        const bool forward = table_.Forward({f, s}, network_);
        boundary.curve[At(s)] = forward ? edge.curve : Reversed(edge.curve);
        boundary.tangent[At(s)] = forward ? edge.tangents[k] : Reversed(edge.tangents[k]);
        if (face.scheme == PatchScheme::kG2Gregory) {
          boundary.rows[At(s)] = forward ? edge.rows[k] : Reversed(edge.rows[k]);
        }
      }
      model.patches.push_back({face.id, MakeFacePatch(boundary, face.scheme)});
    }
    return model;
  }

  // Wishes of a pushed face for one of its edges.
  void Push(const FaceSide& s, const HermiteCurve& edge, const Vec3& b0, const Vec3& b1, Vec3& w0,
            Vec3& w1) const {
    const NetworkFace& face = network_.faces[At(s.face)];
    const bool forward = table_.Forward(s, network_);  // then the face lies to the left of its edge
    for (const FacePush& push : face.pushes) {
      EdgePlace place = PlaceBeside(push, SideCount(face), s.side);
      if (!forward) place.along = 1.0 - place.along;
      PushTwists(edge.d0, edge.d1, b0, b1, place, forward ? -push.amount : push.amount, w0, w1);
    }
  }

  // Two edges in line at a corner leave the patch without tangent plane there.
  void CheckCorners(const std::vector<JoinedEdge>& edges) {
    for (int f = 0; f < static_cast<int>(network_.faces.size()); ++f) {
      const int n = SideCount(network_.faces[At(f)]);
      for (int s = 0; s < n; ++s) {
        const Vec3 a = Outgoing(edges, {f, s}, true), b = Outgoing(edges, {f, (s + n - 1) % n}, false);
        if (a.cross(b).norm() > kMinTangentSine * a.norm() * b.norm()) continue;
        findings_.Error(
            "PARALLEL_TANGENTS", findings_.AtFace(f),
            fmt::format("has two edges in line at vertex {}", network_.faces[At(f)].vertices[At(s)]));
      }
    }
  }

 private:
  const CornerNormal& CornerOf(const FaceSide& s, bool start) const {
    return normals_[At(s.face)][At(CornerAt(network_, table_, s, start))];
  }
  Vec3 NormalAt(const FaceSide& s, bool start) const { return CornerOf(s, start).unit; }

  Where Place(const JoinedEdge& edge) const {
    return edge.topology.given ? findings_.AtEdge(*edge.topology.given)
                               : findings_.AtVertex(edge.topology.start);
  }

  // Outgoing tangent of a face's side at its first (last) corner.
  Vec3 Outgoing(const std::vector<JoinedEdge>& edges, const FaceSide& s, bool first) const {
    const BezierCurve& curve = edges[At(table_.face_edges[At(s.face)][At(s.side)])].curve;
    const HermiteCurve ends = HermiteOf(curve);
    return table_.Forward(s, network_) == first ? ends.d0 : Vec3(-ends.d1);
  }

  // Outgoing tangent of the face's other edge at the start (end) of the edge of side `s`.
  Vec3 Beside(const std::vector<JoinedEdge>& edges, const FaceSide& s, bool start) const {
    const int n = SideCount(network_.faces[At(s.face)]);
    const bool first = table_.Forward(s, network_) == start;  // at the side's own first corner
    return Outgoing(edges, {s.face, first ? (s.side + n - 1) % n : (s.side + 1) % n}, !first);
  }

  // Tangent direction at one end from the normals there, |chord| long; nothing after a finding.
  std::optional<Vec3> FromNormals(const JoinedEdge& edge, bool start, double gamma) {
    const Vec3 from = network_.vertices[At(start ? edge.topology.start : edge.topology.end)].position;
    const Vec3 to = network_.vertices[At(start ? edge.topology.end : edge.topology.start)].position;
    const Vec3 chord = to - from;
    const CornerNormal& first = CornerOf(edge.topology.faces[0], start);
    const CornerNormal& last = CornerOf(edge.topology.faces.back(), start);
    const Vec3 n = first.loose ? last.unit : first.unit;
    if (!first.loose && !last.loose) {
      const Vec3 line = n.cross(last.unit);
      if (line.norm() > kMinTangentSine) {  // a crease: in both tangent planes
        const double along = line.normalized().dot(chord);
        if (std::abs(along) > kMinProjection * chord.norm()) {
          return Vec3(std::copysign(gamma * chord.norm(), along) * line.normalized());
        }
      }
    }
    const auto tangent = FmillTangent(chord, n, gamma);
    if (tangent.ok()) return *tangent;
    findings_.Error("CHORD_ALONG_NORMAL", Place(edge),
                    fmt::format("from vertex {} to {}: {}", edge.topology.start, edge.topology.end,
                                std::string(tangent.status().message())));
    return std::nullopt;
  }

  // The tangent of a smooth joint must lie in the plane of every face beside it.
  void CheckPlanes(const JoinedEdge& edge) {
    const HermiteCurve ends = HermiteOf(edge.curve);
    for (const bool start : {true, false}) {
      const int vertex = start ? edge.topology.start : edge.topology.end;
      const Vec3 tangent = (start ? ends.d0 : ends.d1).normalized();
      for (const FaceSide& s : edge.topology.faces) {
        const double tilt = std::asin(std::min(1.0, std::abs(tangent.dot(NormalAt(s, start)))));
        if (tilt <= kMaxTangentTilt || !Constrained(s, start)) continue;
        findings_.Error(
            "INCONSISTENT_NORMALS", Place(edge),
            fmt::format("leaves vertex {} at {:.3g} rad from the tangent plane of faces[{}]; at most {:g}",
                        vertex, tilt, s.face, kMaxTangentTilt));
      }
      if (edge.kind != EdgeKind::kSmooth) continue;
      const Vec3 a = NormalAt(edge.topology.faces[0], start), b = NormalAt(edge.topology.faces[1], start);
      if (a.cross(b).norm() > kMaxTangentTilt) {
        findings_.Error(
            "INCONSISTENT_NORMALS", Place(edge),
            fmt::format("is smooth, but its faces have normals {:.3g} rad apart at vertex {}; make it a "
                        "crease or give one normal",
                        std::asin(std::min(1.0, a.cross(b).norm())), vertex));
      }
    }
  }

  // Whether the face meets another one smoothly at that corner, so that its plane there is not its own
  // affair.
  bool Constrained(const FaceSide& s, bool start) const {
    const int corner = CornerAt(network_, table_, s, start), n = SideCount(network_.faces[At(s.face)]);
    for (const int side : {corner, (corner + n - 1) % n}) {
      const TableEdge& edge = table_.edges[At(table_.face_edges[At(s.face)][At(side)])];
      if (edge.faces.size() == 2 && !edge.crease) return true;
    }
    return false;
  }

  void MakeCurve(JoinedEdge& edge) {
    const Vec3& p0 = network_.vertices[At(edge.topology.start)].position;
    const Vec3& p1 = network_.vertices[At(edge.topology.end)].position;
    HermiteCurve straight{p0, p1 - p0, p1, p1 - p0};  // stands in after a finding
    edge.curve = ToBezier(straight);
    static const EdgeShape kDefault = NormalsEdge{};
    const EdgeShape& shape = edge.topology.given ? network_.edges[At(*edge.topology.given)].shape : kDefault;
    if (const auto* given = std::get_if<CurveEdge>(&shape)) {
      if (!TakeCurve(given->curve, edge)) return;
    } else if (const auto* tangents = std::get_if<TangentsEdge>(&shape)) {
      edge.curve = ToBezier(HermiteCurve{p0, tangents->start, p1, -tangents->end});
    } else {
      const auto* through = std::get_if<ThroughPointEdge>(&shape);
      const double gamma = through != nullptr ? 1.0 : std::get<NormalsEdge>(shape).gamma;
      auto t1 = FromNormals(edge, true, gamma), t2 = FromNormals(edge, false, gamma);
      if (!t1 || !t2) return;
      if (through != nullptr && !FitLengths(through->point, edge, *t1, *t2)) return;
      edge.curve = ToBezier(HermiteCurve{p0, *t1, p1, -*t2});
    }
    CheckPlanes(edge);
  }

  // Scales the tangents so that Hosaka's segment passes through `point` (41).
  bool FitLengths(const Vec3& point, const JoinedEdge& edge, Vec3& t1, Vec3& t2) {
    const Vec3& p0 = network_.vertices[At(edge.topology.start)].position;
    const HosakaSegment segment{p0, network_.vertices[At(edge.topology.end)].position - p0, t1, -t2, {}};
    const auto axes = HosakaAxes(segment);
    if (axes.ok()) {
      const auto fit = FitThroughPoint(segment.a.norm(), *axes * segment.b.normalized(),
                                       *axes * segment.c.normalized(), *axes * (point - p0));
      if (fit.ok()) {
        t1 = fit->b * t1.normalized();
        t2 = fit->c * t2.normalized();
        return true;
      }
      findings_.Error("NO_FIT", Place(edge), std::string(fit.status().message()));
    } else {
      findings_.Error("NO_FIT", Place(edge), std::string(axes.status().message()));
    }
    return false;
  }

  bool TakeCurve(const Curve& given, JoinedEdge& edge) {
    const auto bezier = ToBezier(given);
    if (!bezier.ok()) {
      findings_.Error("UNSUPPORTED_CURVE", Place(edge), std::string(bezier.status().message()));
      return false;
    }
    const Vec3 ends[2] = {network_.vertices[At(edge.topology.start)].position,
                          network_.vertices[At(edge.topology.end)].position};
    BezierCurve curve = Elevated(*bezier, std::max(3, bezier->degree()));
    const double gap =
        std::max((curve.points.front() - ends[0]).norm(), (curve.points.back() - ends[1]).norm());
    if (!(gap <= 1e-9 * (ends[1] - ends[0]).norm() + 1e-12 * ends[0].norm())) {
      findings_.Error("CURVE_OFF_VERTEX", Place(edge), fmt::format("misses its vertices by {:g}", gap));
      return false;
    }
    curve.points.front() = ends[0];
    curve.points.back() = ends[1];
    edge.curve = std::move(curve);
    return true;
  }

  const CurveNetwork& network_;
  const EdgeTable& table_;
  std::vector<std::array<CornerNormal, 4>> normals_;
  NetworkWriter findings_;
  std::vector<JoinedEdge> edges_;
};

}  // namespace

JoinedNetwork JoinNetwork(const CurveNetwork& given) {
  JoinedNetwork joined;
  const CurveNetwork network = WithLinesAsEdges(given, joined.findings);
  const EdgeTable table = BuildEdgeTable(network, joined.findings);
  if (HasError(joined.findings)) return joined;
  Joiner joiner(network, table, joined.findings);
  joined.edges = joiner.Edges();
  if (!HasError(joined.findings)) joiner.CheckCorners(joined.edges);
  if (!HasError(joined.findings)) joiner.CheckSchemes(joined.edges);
  if (!HasError(joined.findings)) joiner.Tangents(joined.edges);
  if (!HasError(joined.findings)) joiner.Rows(joined.edges);
  if (!HasError(joined.findings)) joined.model = joiner.Patches(joined.edges);
  if (HasError(joined.findings)) joined.edges.clear(), joined.model = {};
  return joined;
}

}  // namespace patchmill
