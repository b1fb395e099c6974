#include "core/joining/edge_shapes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/curve/bezier_chain.h"
#include "core/curve/fitted_tangents.h"
#include "core/joining/cross_tangents.h"

namespace patchmill {
namespace {

class Shaper {
 public:
  Shaper(const JoinFrame& frame, const TableEdge& edge)
      : frame_(frame),
        edge_(edge),
        p0_(frame.network.vertices[At(edge.start)].position),
        p1_(frame.network.vertices[At(edge.end)].position) {}

  std::optional<BezierChain> Make() const {
    static const EdgeShape kDefault = NormalsEdge{};
    const EdgeShape& shape = edge_.given ? frame_.network.edges[At(*edge_.given)].shape : kDefault;
    if (const auto* given = std::get_if<CurveEdge>(&shape)) return Take(given->curve);
    if (const auto* tangents = std::get_if<TangentsEdge>(&shape)) {
      return AsChain(ToBezier(HermiteCurve{p0_, tangents->start, p1_, -tangents->end}));
    }
    const auto* led = std::get_if<LedEdge>(&shape);
    const auto* plain = led != nullptr ? &led->ends : std::get_if<NormalsEdge>(&shape);
    const double gamma = plain != nullptr ? plain->gamma : 1.0;
    const auto t1 = FromNormals(true, gamma), t2 = FromNormals(false, gamma);
    if (!t1 || !t2) return std::nullopt;
    const EdgeDirections ends{p0_, t1->normalized(), p1_, t2->normalized()};
    const auto fit = plain != nullptr ? Lengths(*plain, {*t1, *t2}, ends) : Fit(shape, ends);
    if (!fit.ok()) {
      Error("NO_FIT", std::string(fit.status().message()));
      return std::nullopt;
    }
    const HermiteCurve cubic = EdgeCurve(p0_, p1_, *fit);
    if (led == nullptr) return AsChain(ToBezier(cubic));
    BezierCurve curve = *ToBezier(Curve(LedThrough(cubic, led->parameter, led->point, led->derivative)));
    curve.points.back() = p1_;
    return AsChain(std::move(curve));
  }

  // A part of the whole edge's curve, with the degree that it takes to follow the leading face
  // (cross_tangents.h).
  BezierChain PartOf(const JoinedEdge& whole) const {
    const bool cubic = CubicAcross(frame_.network.faces[At(whole.topology.faces[0].face)]);
    const int degree = std::max(whole.curve.degree, cubic ? 4 : 3);
    BezierChain curve = Elevated(Part(whole.curve, edge_.part->from, edge_.part->to), degree);
    curve.points.front() = p0_;
    curve.points.back() = p1_;
    return curve;
  }

 private:
  Where Place() const {
    return edge_.given ? frame_.findings.AtEdge(*edge_.given) : frame_.findings.AtVertex(edge_.start);
  }
  void Error(std::string_view code, std::string_view text) const {
    frame_.findings.Error(code, Place(), text);
  }

  // The corner normal at one end, on the other side of the edge. For a divided edge it is that of the face
  // along its first (last) part.
  const CornerNormal& Opposite(bool start) const {
    const int vertex = start ? edge_.start : edge_.end;
    for (const int p : edge_.parts) {
      const TableEdge& part = frame_.table.edges[At(p)];
      if (part.start == vertex || part.end == vertex)
        return frame_.CornerNormalAt(part.faces[0], part.start == vertex);
    }
    return frame_.CornerNormalAt(edge_.faces.back(), start);
  }

  // Tangent direction at one end from the normals there, gamma |chord| long; nullopt after a finding.
  std::optional<Vec3> FromNormals(bool start, double gamma) const {
    const Vec3 chord = start ? Vec3(p1_ - p0_) : Vec3(p0_ - p1_);
    const CornerNormal& first = frame_.CornerNormalAt(edge_.faces[0], start);
    const CornerNormal& last = Opposite(start);
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
    Error("CHORD_ALONG_NORMAL", fmt::format("from vertex {} to {}: {}", edge_.start, edge_.end,
                                            std::string(tangent.status().message())));
    return std::nullopt;
  }

  static absl::StatusOr<EdgeTangents> Lengths(const NormalsEdge& edge, const EdgeTangents& fmill,
                                              const EdgeDirections& ends) {
    if (edge.length == TangentLength::kChord) return fmill;
    PM_ASSIGN_OR_RETURN(const EdgeTangents t,
                        edge.length == TangentLength::kArc
                            ? ArcTangents(ends)
                            : QuarterEllipseTangents(ends.p1, ends.u1, ends.p2, ends.u2));
    return EdgeTangents{edge.gamma * t.t1, edge.gamma * t.t2};
  }

  static absl::StatusOr<EdgeTangents> Fit(const EdgeShape& shape, const EdgeDirections& ends) {
    if (const auto* peak = std::get_if<PeakEdge>(&shape)) return TangentsWithPeak(ends, peak->peak);
    if (const auto* slope = std::get_if<SlopeEdge>(&shape)) {
      return TangentsWithSlope(ends, slope->point, slope->direction);
    }
    return TangentsThroughPoint(ends, std::get<ThroughPointEdge>(shape).point);
  }

  std::optional<BezierChain> Take(const Curve& given) const {
    auto chain = ChainOf(given);
    if (!chain.ok()) {
      Error("UNSUPPORTED_CURVE", std::string(chain.status().message()));
      return std::nullopt;
    }
    const int degree = std::max(3, chain->degree);
    BezierChain curve = Elevated(*std::move(chain), degree);
    const double gap = std::max((curve.points.front() - p0_).norm(), (curve.points.back() - p1_).norm());
    if (!(gap <= 1e-9 * (p1_ - p0_).norm() + 1e-12 * p0_.norm())) {
      Error("CURVE_OFF_VERTEX", fmt::format("misses its vertices by {:g}", gap));
      return std::nullopt;
    }
    curve.points.front() = p0_;
    curve.points.back() = p1_;
    if (const std::string fault = SpanFault(curve); !fault.empty()) {
      Error("UNSUPPORTED_CURVE", fault);
      return std::nullopt;
    }
    return curve;
  }

  // Says why the spans cannot make one edge; empty if they can.
  static std::string SpanFault(const BezierChain& curve) {
    if (curve.spans() > kMaxBrownBreaks + 1) {
      return fmt::format("has a curve of {} spans; at most {}", curve.spans(), kMaxBrownBreaks + 1);
    }
    for (int k = 0; k < curve.spans(); ++k) {
      const double at = curve.breaks[At(k)], length = curve.breaks[At(k + 1)] - at;
      if (!(length > 10.0 * kMinBreakGap)) {
        return fmt::format("has a curve with knots {:g} of its domain apart; at least {:g}", length,
                           10.0 * kMinBreakGap);
      }
      if (k == 0) continue;
      const auto at_break = JetsAtBreak(curve, k);
      if ((at_break[1].d - at_break[0].d).norm() <= kMaxTangentTilt * at_break[0].d.norm()) continue;
      const Vec3& p = at_break[0].p;
      return fmt::format(
          "has a curve whose first derivative jumps at ({:.6g}, {:.6g}, {:.6g}): insert a vertex there, give "
          "the "
          "curve part by part as edges, and let the faces beside it have a side for each",
          p.x(), p.y(), p.z());
    }
    return "";
  }

  const JoinFrame& frame_;
  const TableEdge& edge_;
  const Vec3& p0_;
  const Vec3& p1_;
};

}  // namespace

std::optional<BezierChain> MakeEdgeCurve(const JoinFrame& frame, const std::vector<JoinedEdge>& edges,
                                         const TableEdge& edge) {
  const Shaper shaper(frame, edge);
  if (edge.part) return shaper.PartOf(edges[At(edge.part->whole)]);
  std::optional<BezierChain> curve = shaper.Make();
  // The face across from a Hosaka face follows it, with a tangent of one degree more than the Hosaka face's.
  const auto hosakas = std::ranges::count_if(edge.faces, [&](const FaceSide& s) {
    return frame.network.faces[At(s.face)].scheme == PatchScheme::kHosaka;
  });
  if (curve && !edge.crease && hosakas == 1 && edge.faces.size() == 2) {
    const int degree = std::max(4, curve->degree);
    curve = Elevated(*std::move(curve), degree);
  }
  return curve;
}

BezierChain StraightEdge(const JoinFrame& frame, const TableEdge& edge) {
  const Vec3 &p0 = frame.network.vertices[At(edge.start)].position,
             &p1 = frame.network.vertices[At(edge.end)].position;
  return AsChain(ToBezier(HermiteCurve{p0, p1 - p0, p1, p1 - p0}));
}

}  // namespace patchmill
