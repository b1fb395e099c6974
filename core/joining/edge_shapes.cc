#include "core/joining/edge_shapes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/curve/bezier_chain.h"
#include "core/curve/edge_tangents.h"
#include "core/curve/hosaka_fit.h"

namespace patchmill {
namespace {

std::size_t At(int i) { return static_cast<std::size_t>(i); }

class Shaper {
 public:
  Shaper(const JoinFrame& frame, const TableEdge& edge)
      : frame_(frame),
        edge_(edge),
        p0_(frame.network.vertices[At(edge.start)].position),
        p1_(frame.network.vertices[At(edge.end)].position) {}

  std::optional<BezierCurve> Make() const {
    static const EdgeShape kDefault = NormalsEdge{};
    const EdgeShape& shape = edge_.given ? frame_.network.edges[At(*edge_.given)].shape : kDefault;
    if (const auto* given = std::get_if<CurveEdge>(&shape)) return Take(given->curve);
    if (const auto* tangents = std::get_if<TangentsEdge>(&shape)) {
      return ToBezier(HermiteCurve{p0_, tangents->start, p1_, -tangents->end});
    }
    const auto* through = std::get_if<ThroughPointEdge>(&shape);
    const double gamma = through != nullptr ? 1.0 : std::get<NormalsEdge>(shape).gamma;
    auto t1 = FromNormals(true, gamma), t2 = FromNormals(false, gamma);
    if (!t1 || !t2) return std::nullopt;
    if (through != nullptr && !FitLengths(through->point, *t1, *t2)) return std::nullopt;
    return ToBezier(HermiteCurve{p0_, *t1, p1_, -*t2});
  }

  // Of the whole edge's curve, with the degree that following the leading face takes (part_tangents.h).
  BezierCurve PartOf(const JoinedEdge& whole) const {
    const NetworkFace& leader = frame_.network.faces[At(whole.topology.faces[0].face)];
    const int degree = std::max(whole.curve.degree(), leader.pushes.empty() ? 3 : 4);
    BezierCurve curve = Elevated(Part(whole.curve, edge_.part->from, edge_.part->to), degree);
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

  // The corner at one end on the other side of the edge: of a divided one, the face along its first (last)
  // part.
  const CornerNormal& Opposite(bool start) const {
    const int vertex = start ? edge_.start : edge_.end;
    for (const int p : edge_.parts) {
      const TableEdge& part = frame_.table.edges[At(p)];
      if (part.start == vertex || part.end == vertex)
        return frame_.CornerNormalAt(part.faces[0], part.start == vertex);
    }
    return frame_.CornerNormalAt(edge_.faces.back(), start);
  }

  // Tangent direction at one end from the normals there, gamma |chord| long; nothing after a finding.
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

  // Scales the tangents so that Hosaka's segment passes through `point` (41).
  bool FitLengths(const Vec3& point, Vec3& t1, Vec3& t2) const {
    const HosakaSegment segment{p0_, p1_ - p0_, t1, -t2, {}};
    const auto axes = HosakaAxes(segment);
    if (!axes.ok()) {
      Error("NO_FIT", std::string(axes.status().message()));
      return false;
    }
    const auto fit = FitThroughPoint(segment.a.norm(), *axes * segment.b.normalized(),
                                     *axes * segment.c.normalized(), *axes * (point - p0_));
    if (!fit.ok()) {
      Error("NO_FIT", std::string(fit.status().message()));
      return false;
    }
    t1 = fit->b * t1.normalized();
    t2 = fit->c * t2.normalized();
    return true;
  }

  std::optional<BezierCurve> Take(const Curve& given) const {
    const auto bezier = ToBezier(given);
    if (!bezier.ok()) {
      Error("UNSUPPORTED_CURVE", WhyNotOnePolynomial(given, bezier.status()));
      return std::nullopt;
    }
    BezierCurve curve = Elevated(*bezier, std::max(3, bezier->degree()));
    const double gap = std::max((curve.points.front() - p0_).norm(), (curve.points.back() - p1_).norm());
    if (!(gap <= 1e-9 * (p1_ - p0_).norm() + 1e-12 * p0_.norm())) {
      Error("CURVE_OFF_VERTEX", fmt::format("misses its vertices by {:g}", gap));
      return std::nullopt;
    }
    curve.points.front() = p0_;
    curve.points.back() = p1_;
    return curve;
  }

  // Of several spans: where vertices would have to stand.
  static std::string WhyNotOnePolynomial(const Curve& given, const absl::Status& status) {
    constexpr std::size_t kMaxTold = 8;
    const auto chain = ChainOf(given);
    if (!chain.ok() || chain->spans() < 2) return std::string(status.message());
    std::string places;
    const auto last = chain->breaks.size() - 1;
    for (std::size_t k = 1; k < std::min(last, kMaxTold + 1); ++k) {
      const Vec3& p = chain->points[k * At(chain->degree)];
      places += fmt::format("{}({:.6g}, {:.6g}, {:.6g})", k > 1 ? ", " : "", p.x(), p.y(), p.z());
    }
    if (last > kMaxTold + 1) places += ", ...";
    return fmt::format(
        "has a curve of {} spans, an edge takes one: insert vertices at {}, give the curve span by span as "
        "edges "
        "between them, and let the faces beside it have a side for each",
        chain->spans(), places);
  }

  const JoinFrame& frame_;
  const TableEdge& edge_;
  const Vec3& p0_;
  const Vec3& p1_;
};

}  // namespace

std::optional<BezierCurve> MakeEdgeCurve(const JoinFrame& frame, const std::vector<JoinedEdge>& edges,
                                         const TableEdge& edge) {
  const Shaper shaper(frame, edge);
  return edge.part ? shaper.PartOf(edges[At(edge.part->whole)]) : shaper.Make();
}

BezierCurve StraightEdge(const JoinFrame& frame, const TableEdge& edge) {
  const Vec3 &p0 = frame.network.vertices[At(edge.start)].position,
             &p1 = frame.network.vertices[At(edge.end)].position;
  return ToBezier(HermiteCurve{p0, p1 - p0, p1, p1 - p0});
}

}  // namespace patchmill
