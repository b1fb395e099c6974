#include "core/joining/joint_checks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/curve/hosaka_fit.h"
#include "core/joining/cross_tangents.h"
#include "core/joining/face_patch.h"

namespace patchmill {
namespace {

// Whether the face meets another one smoothly at that corner, so that both must have one plane there.
bool Constrained(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const FaceSide& s,
                 bool start) {
  const int corner = frame.CornerAt(s, start), n = SideCount(frame.network.faces[At(s.face)]);
  for (const int side : {corner, (corner + n - 1) % n}) {
    const EdgeKind kind = edges[At(frame.table.face_edges[At(s.face)][At(side)])].kind;
    if (kind != EdgeKind::kFree && kind != EdgeKind::kCrease) return true;
  }
  return false;
}

void CheckSame(const JoinFrame& frame, const JoinedEdge& edge, int vertex, const Vec3& a, const Vec3& b) {
  const double sine = a.cross(b).norm();
  if (sine <= kMaxTangentTilt) return;
  frame.findings.Error("INCONSISTENT_NORMALS", frame.Place(edge),
                       fmt::format("is smooth, but its faces have normals {:.3g} rad apart at vertex {}; "
                                   "make it a crease or give one normal",
                                   std::asin(std::min(1.0, sine)), vertex));
}

}  // namespace

void CheckPlanes(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const JoinedEdge& edge) {
  const HermiteCurve ends = HermiteOf(edge.curve);
  const TableEdge& at = edge.topology;
  for (const bool start : {true, false}) {
    const int vertex = start ? at.start : at.end;
    const Vec3 tangent = (start ? ends.d0 : ends.d1).normalized();
    for (const FaceSide& s : at.faces) {
      const double tilt = std::asin(std::min(1.0, std::abs(tangent.dot(frame.NormalAt(s, start)))));
      if (tilt <= kMaxTangentTilt || !Constrained(frame, edges, s, start)) continue;
      frame.findings.Error(
          "INCONSISTENT_NORMALS", frame.Place(edge),
          fmt::format("leaves vertex {} at {:.3g} rad from the tangent plane of faces[{}]; at most {:g}",
                      vertex, tilt, s.face, kMaxTangentTilt));
    }
    const Vec3 here = frame.NormalAt(at.faces[0], start);
    if (edge.kind == EdgeKind::kSmooth)
      CheckSame(frame, edge, vertex, here, frame.NormalAt(at.faces[1], start));
    if (edge.kind ==
        EdgeKind::kFollowing) {  // at the ends of the whole edge the leader has a normal of its own
      const TableEdge& whole = edges[At(at.part->whole)].topology;
      if (vertex != whole.start && vertex != whole.end) continue;
      CheckSame(frame, edge, vertex, here, frame.NormalAt(whole.faces[0], vertex == whole.start));
    }
  }
}

void CheckLoop(const JoinFrame& frame, const JoinedEdge& edge) {
  if (edge.curve.degree != 3 || edge.curve.spans() > 1) return;
  const auto loop = FindLoop(HermiteOf(edge.curve));
  if (!loop) return;
  const double gap = (Evaluate(edge.curve, loop->first).p - Evaluate(edge.curve, loop->second).p).norm();
  frame.findings.Warning("LOOPED_EDGE", frame.Place(edge),
                         fmt::format("from vertex {} to {} loops between {:.4g} and {:.4g} of its parameter "
                                     "and passes itself at {:.3g}; "
                                     "its tangents are too long",
                                     edge.topology.start, edge.topology.end, loop->first, loop->second, gap));
}

void CheckCorners(const JoinFrame& frame, const std::vector<JoinedEdge>& edges) {
  for (int f = 0; f < static_cast<int>(frame.network.faces.size()); ++f) {
    const int n = SideCount(frame.network.faces[At(f)]);
    for (int s = 0; s < n; ++s) {
      const Vec3 a = frame.Outgoing(edges, {f, s}, true),
                 b = frame.Outgoing(edges, {f, (s + n - 1) % n}, false);
      if (a.cross(b).norm() > kMinTangentSine * a.norm() * b.norm()) continue;
      frame.findings.Error(
          "PARALLEL_TANGENTS", frame.findings.AtFace(f),
          fmt::format("has two edges in line at vertex {}", frame.network.faces[At(f)].vertices[At(s)]));
    }
  }
}

void CheckSchemes(const JoinFrame& frame, const std::vector<JoinedEdge>& edges) {
  for (int f = 0; f < static_cast<int>(frame.network.faces.size()); ++f) {
    const NetworkFace& face = frame.network.faces[At(f)];
    EdgeDemand demand;
    for (int s = 0; s < SideCount(face); ++s) {
      const JoinedEdge& edge = edges[At(frame.table.face_edges[At(f)][At(s)])];
      demand.degree = std::max(demand.degree, edge.curve.degree);
      demand.spans = std::max(demand.spans, edge.curve.spans());
      if (face.scheme != PatchScheme::kHosaka) continue;
      demand.breaks = std::max(demand.breaks, static_cast<int>(HosakaBreaks(edge, edges).size()));
    }
    if (const auto fault = SchemeFault(face, demand)) {
      frame.findings.Error("UNSUPPORTED_SCHEME", frame.findings.AtFace(f), *fault);
    }
  }
}

}  // namespace patchmill
