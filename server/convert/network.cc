#include "server/convert/network.h"

#include <fmt/format.h>

#include "core/base/status.h"
#include "server/convert/curve_in_file.h"
#include "server/errors.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

class NetworkReader {
 public:
  NetworkReader(double unit, Diagnostics& faults) : unit_(unit), faults_(faults) {}

  CurveNetwork Read(const v1::CurveNetwork& proto) {
    CurveNetwork network;
    for (int i = 0; i < proto.vertices_size(); ++i) network.vertices.push_back(Vertex(proto.vertices(i), i));
    vertices_ = &network.vertices;
    for (int i = 0; i < proto.edges_size(); ++i) network.edges.push_back(Edge(proto.edges(i), i));
    for (int i = 0; i < proto.faces_size(); ++i) network.faces.push_back(Face(proto.faces(i), i));
    for (int k = 0; k < proto.lines_size(); ++k) network.lines.push_back(Line(proto.lines(k), k));
    for (int i = 0; i < proto.edges_size(); ++i) {
      const v1::NetworkEdge& edge = proto.edges(i);
      for (int k = 0; k < edge.controls_size(); ++k) {
        network.controls.push_back(Control(edge.start(), edge.end(), edge.controls(k),
                                           fmt::format("network.edges[{}].controls[{}]", i, k)));
      }
    }
    for (int k = 0; k < proto.controls_size(); ++k) {
      const v1::EdgeControl& from = proto.controls(k);
      const std::string at = fmt::format("network.controls[{}].control", k);
      network.controls.push_back(Control(from.start(), from.end(), from.control(), at));
    }
    return network;
  }

 private:
  void Fault(std::string_view code, std::string field, std::string_view text) {
    std::string message = fmt::format("{} {}", field, text);
    faults_.push_back(MakeError(code, std::move(message), {.field = std::move(field)}));
  }

  std::string Id(const std::string& id, const std::string& at) {
    if (id.size() > limits::kMaxIdBytes) {
      Fault("INVALID_ID", at + ".id",
            fmt::format("has {} bytes; must have at most {}", id.size(), limits::kMaxIdBytes));
    }
    return id;
  }

  Vec3 Vector(const Numbers& numbers, double factor, const std::string& field) {
    if (numbers.size() == 3) return factor * Vec3(numbers[0], numbers[1], numbers[2]);
    Fault("POINT_COUNT", field, fmt::format("has {} numbers; must have x y z", numbers.size()));
    return Vec3::Zero();
  }

  std::vector<Vec3> Points(const Numbers& numbers, std::size_t least, std::size_t most,
                           const std::string& field) {
    const auto count = static_cast<std::size_t>(numbers.size());
    if (count % 3 != 0 || count < 3 * least || count > 3 * most) {
      Fault("POINT_COUNT", field,
            fmt::format("has {} numbers; must be packed x y z of {} to {} points", count, least, most));
      return {};
    }
    std::vector<Vec3> points(count / 3);
    for (int i = 0; i < numbers.size(); ++i)
      points[static_cast<std::size_t>(i / 3)][i % 3] = unit_ * numbers[i];
    return points;
  }

  NetworkVertex Vertex(const v1::NetworkVertex& from, int index) {
    const std::string at = fmt::format("network.vertices[{}]", index);
    NetworkVertex vertex;
    vertex.id = Id(from.id(), at);
    if (from.has_on_edge()) {
      vertex.on_edge = {from.on_edge().start(), from.on_edge().end(), from.on_edge().parameter()};
      if (!from.position().empty()) {
        Fault("INVALID_T_VERTEX", at + ".position",
              "is set together with on_edge, which states the place; leave it out");
      }
    } else {
      vertex.position = Vector(from.position(), unit_, at + ".position");
    }
    for (const v1::VertexNormal& normal : from.normals()) {
      vertex.normals.push_back({Vector(normal.direction(), 1.0, at + ".normals.direction"),
                                {normal.faces().begin(), normal.faces().end()}});
    }
    return vertex;
  }

  NetworkLine Line(const v1::NetworkLine& from, int index) {
    const std::string at = fmt::format("network.lines[{}]", index);
    const auto optional = [&](const Numbers& numbers, double factor, const char* field) {
      return numbers.empty() ? std::nullopt : std::optional(Vector(numbers, factor, at + field));
    };
    return {{from.vertices().begin(), from.vertices().end()},
            from.closed(),
            from.crease(),
            {optional(from.start_direction(), 1.0, ".start_direction"),
             optional(from.start_curvature(), 1.0 / unit_, ".start_curvature")},
            {optional(from.end_direction(), 1.0, ".end_direction"),
             optional(from.end_curvature(), 1.0 / unit_, ".end_curvature")}};
  }

  EdgeShape Shape(const v1::NetworkEdge& from, const std::string& at) {
    switch (from.shape_case()) {
      case v1::NetworkEdge::kFromNormals:
        return FromNormals(from.from_normals(), at + ".from_normals");
      case v1::NetworkEdge::kFromTangents:
        return TangentsEdge{
            Vector(from.from_tangents().start_tangent(), unit_, at + ".from_tangents.start_tangent"),
            Vector(from.from_tangents().end_tangent(), unit_, at + ".from_tangents.end_tangent")};
      case v1::NetworkEdge::kThroughPoint:
        return ThroughPointEdge{
            Vector(from.through_point().position(), unit_, at + ".through_point.position")};
      case v1::NetworkEdge::kBezier: {
        const BezierCurve curve{Points(from.bezier().points(), 2, kMaxEdgePoints, at + ".bezier.points")};
        if (curve.points.empty()) return NormalsEdge{};
        return CurveEdge{curve};
      }
      case v1::NetworkEdge::kBspline:
        return Bspline(from.bspline(), at + ".bspline");
      case v1::NetworkEdge::kWithPeak:
        return PeakEdge{Vector(from.with_peak().position(), unit_, at + ".with_peak.position")};
      case v1::NetworkEdge::kWithSlope:
        return SlopeEdge{Vector(from.with_slope().position(), unit_, at + ".with_slope.position"),
                         Vector(from.with_slope().direction(), 1.0, at + ".with_slope.direction")};
      case v1::NetworkEdge::kWithExtremum:
        return SlopeEdge{Vector(from.with_extremum().position(), unit_, at + ".with_extremum.position"), {}};
      case v1::NetworkEdge::kLedThrough:
        return Led(from.led_through(), at + ".led_through");
      case v1::NetworkEdge::kHosaka:
        return Hosaka(from.hosaka(), at + ".hosaka");
      case v1::NetworkEdge::kFile:  // read by Edge
      case v1::NetworkEdge::SHAPE_NOT_SET:
        break;
    }
    return NormalsEdge{};
  }

  NormalsEdge FromNormals(const v1::CurveFromNormals& from, const std::string& at) {
    NormalsEdge edge{from.has_gamma() ? from.gamma() : 1.0};
    switch (from.length()) {
      case v1::TANGENT_LENGTH_UNSPECIFIED:
        break;
      case v1::TANGENT_LENGTH_ARC:
        edge.length = TangentLength::kArc;
        break;
      case v1::TANGENT_LENGTH_QUARTER_ELLIPSE:
        edge.length = TangentLength::kQuarterEllipse;
        break;
      default:
        Fault("UNSUPPORTED_CURVE", at + ".length",
              fmt::format("= {}; this server does not know that value", static_cast<int>(from.length())));
    }
    return edge;
  }

  EdgeShape Led(const v1::CurveLedThrough& from, const std::string& at) {
    LedEdge edge{FromNormals(from.from_normals(), at + ".from_normals"),
                 from.parameter(),
                 Vector(from.position(), unit_, at + ".position"),
                 {}};
    if (!from.derivative().empty()) edge.derivative = Vector(from.derivative(), unit_, at + ".derivative");
    return edge;
  }

  EdgeShape Hosaka(const v1::HosakaCurve& from, const std::string& at) {
    HosakaSegment segment;
    segment.origin = Vector(from.origin(), unit_, at + ".origin");
    segment.a = Vector(from.chord(), unit_, at + ".chord");
    segment.b = Vector(from.start_derivative(), unit_, at + ".start_derivative");
    segment.c = Vector(from.end_derivative(), unit_, at + ".end_derivative");
    segment.extra = Points(from.extra_terms(), 0, kMaxEdgePoints - 4, at + ".extra_terms");
    const double start = from.has_part_start() ? from.part_start() : 0.0,
                 end = from.has_part_end() ? from.part_end() : 1.0;
    if (!(start >= 0.0 && start < end && end <= 1.0)) {
      Fault("INVALID_PARAMETER", at + ".part_start",
            fmt::format("= {:g}, part_end = {:g}; must be 0 <= part_start < part_end <= 1", start, end));
      return NormalsEdge{};
    }
    const auto curve = ToBezier(Curve(segment));
    if (!curve.ok()) return NormalsEdge{};  // already reported as a fault
    return CurveEdge{Part(*curve, start, end)};
  }

  EdgeShape Bspline(const v1::BsplineCurve& from, const std::string& at) {
    BsplineCurve curve;
    curve.degree = from.degree();
    curve.knots = {from.knots().begin(), from.knots().end()};
    curve.points = Points(from.points(), 2, limits::kMaxControlPoints, at + ".points");
    if (curve.points.empty()) return NormalsEdge{};
    return CurveEdge{curve};
  }

  CrossControl Control(int start, int end, const v1::CrossControl& from, const std::string& at) {
    CrossControl control{start, end, from.face(), {}, {}};
    if (!from.first_derivative().empty()) {
      control.first = Vector(from.first_derivative(), unit_, at + ".first_derivative");
    }
    if (!from.second_derivative().empty()) {
      control.second = Vector(from.second_derivative(), unit_, at + ".second_derivative");
    }
    return control;
  }

  NetworkEdge Edge(const v1::NetworkEdge& from, int index) {
    const std::string at = fmt::format("network.edges[{}]", index);
    if (from.shape_case() == v1::NetworkEdge::kFile) {
      return {Id(from.id(), at), from.start(), from.end(), InFile(from, at + ".file"), from.crease()};
    }
    return {Id(from.id(), at), from.start(), from.end(), Shape(from, at), from.crease()};
  }

  // The curve of a file between the vertices of the edge, turned round and laid onto them as needed.
  EdgeShape InFile(const v1::NetworkEdge& from, const std::string& at) {
    absl::StatusOr<BezierChain> chain = CurveIn(from.file(), unit_);
    if (!chain.ok()) {
      Fault("UNSUPPORTED_CURVE", at, std::string(chain.status().message()));
      return NormalsEdge{};
    }
    const int count = static_cast<int>(vertices_->size());
    if (from.start() < 0 || from.start() >= count || from.end() < 0 || from.end() >= count)
      return NormalsEdge{};
    const Vec3& start = (*vertices_)[static_cast<std::size_t>(from.start())].position;
    const Vec3& end = (*vertices_)[static_cast<std::size_t>(from.end())].position;
    const Vec3 first = chain->points.front(), last = chain->points.back();
    if ((first - end).norm() + (last - start).norm() < (first - start).norm() + (last - end).norm()) {
      *chain = Reversed(*std::move(chain));
    }
    const Vec3 at_start = start - chain->points.front(), at_end = end - chain->points.back();
    constexpr double kMostShare = 1e-3;
    const double off = std::max(at_start.norm(), at_end.norm()), chord = (end - start).norm();
    if (!(off <= kMostShare * chord)) {
      Fault("UNSUPPORTED_CURVE", at,
            fmt::format(
                "has a curve whose ends lie {:.4g} mm from the vertices {} and {}; at most {:g} of their "
                "distance {:.4g} mm",
                off, from.start(), from.end(), kMostShare, chord));
      return NormalsEdge{};
    }
    const std::vector<double> shares = ControlAbscissae(*chain);
    for (std::size_t k = 0; k < shares.size(); ++k) {
      chain->points[k] += (1.0 - shares[k]) * at_start + shares[k] * at_end;
    }
    chain->points.front() = start, chain->points.back() = end;
    if (chain->spans() == 1) return CurveEdge{BezierCurve{chain->points}};
    return CurveEdge{AsBspline(*chain)};
  }

  FacePush Push(const v1::FacePush& push) const { return {push.u(), push.v(), push.amount() / unit_}; }

  NetworkFace Face(const v1::NetworkFace& from, int index) {
    const std::string at = fmt::format("network.faces[{}]", index);
    NetworkFace face;
    face.id = Id(from.id(), at);
    face.vertices = {from.vertices().begin(), from.vertices().end()};
    for (const v1::FaceCut& cut : from.cuts()) face.cuts.push_back({cut.start(), cut.end()});
    for (const v1::SideTwists& twists : from.twists()) {
      SideTwists& to = face.twists.emplace_back(SideTwists{twists.start(), twists.end(), {}, {}});
      if (!twists.start_twist().empty()) {
        to.at_start = Vector(twists.start_twist(), unit_, at + ".twists.start_twist");
      }
      if (!twists.end_twist().empty())
        to.at_end = Vector(twists.end_twist(), unit_, at + ".twists.end_twist");
    }
    if (from.has_push()) face.pushes.push_back(Push(from.push()));
    if (static_cast<std::size_t>(from.more_pushes_size()) >= kMaxFacePushes) {
      Fault("INVALID_PUSH", at + ".more_pushes",
            fmt::format("are {}; must be at most {}", from.more_pushes_size(), kMaxFacePushes - 1));
      return face;
    }
    for (const v1::FacePush& push : from.more_pushes()) face.pushes.push_back(Push(push));
    if (static_cast<std::size_t>(from.bulges_size()) > kMaxBulges) {
      Fault("INVALID_BULGE", at + ".bulges",
            fmt::format("are {}; must be at most {}", from.bulges_size(), kMaxBulges));
      return face;
    }
    for (int k = 0; k < from.bulges_size(); ++k) {
      const v1::Bulge& bulge = from.bulges(k);
      face.bulges.push_back(
          {bulge.u(), bulge.v(), Vector(bulge.by(), unit_, fmt::format("{}.bulges[{}].by", at, k))});
    }
    switch (from.scheme()) {
      case v1::PATCH_SCHEME_UNSPECIFIED:
        break;
      case v1::PATCH_SCHEME_GREGORY:
        face.scheme = PatchScheme::kGregory;
        break;
      case v1::PATCH_SCHEME_BROWN:
        face.scheme = PatchScheme::kBrown;
        break;
      case v1::PATCH_SCHEME_LOFT_TRIANGLE:
        face.scheme = PatchScheme::kLoftTriangle;
        break;
      case v1::PATCH_SCHEME_GREGORY_TRIANGLE:
        face.scheme = PatchScheme::kGregoryTriangle;
        break;
      case v1::PATCH_SCHEME_G2_GREGORY:
        face.scheme = PatchScheme::kG2Gregory;
        break;
      case v1::PATCH_SCHEME_HOSAKA:
        face.scheme = PatchScheme::kHosaka;
        break;
      default:
        Fault("UNSUPPORTED_SCHEME", at + ".scheme",
              fmt::format("= {}; this server does not know that value", static_cast<int>(from.scheme())));
    }
    return face;
  }

  static constexpr std::size_t kMaxEdgePoints = kMaxBrownDegree + 1;
  double unit_;
  const std::vector<NetworkVertex>* vertices_ = nullptr;  // of the network that is read
  Diagnostics& faults_;
};

}  // namespace

absl::Status CheckNetworkLimits(const v1::CurveNetwork& proto) {
  const auto check = [](std::string_view what, std::size_t most, std::size_t count) {
    return count <= most ? absl::OkStatus()
                         : LimitError(what, static_cast<double>(most), static_cast<double>(count));
  };
  const auto size = [](const auto& list) { return static_cast<std::size_t>(list.size()); };
  PM_RETURN_IF_ERROR(
      check("model.network.vertex_count", limits::kMaxNetworkVertices, size(proto.vertices())));
  PM_RETURN_IF_ERROR(check("model.network.edge_count", limits::kMaxNetworkEdges, size(proto.edges())));
  PM_RETURN_IF_ERROR(check("model.patch_count", limits::kMaxPatches, size(proto.faces())));
  std::size_t line_vertices = 0;
  for (const v1::NetworkLine& line : proto.lines()) line_vertices += size(line.vertices());
  PM_RETURN_IF_ERROR(check("model.network.line_count", limits::kMaxNetworkEdges, size(proto.lines())));
  PM_RETURN_IF_ERROR(check("model.network.control_count", limits::kMaxNetworkEdges, size(proto.controls())));
  PM_RETURN_IF_ERROR(check("model.network.line_vertex_count", limits::kMaxNetworkVertices, line_vertices));
  std::size_t references = 0, points = 0, knots = 0;
  for (const v1::NetworkVertex& vertex : proto.vertices()) {
    references += size(vertex.normals());
    for (const v1::VertexNormal& normal : vertex.normals()) references += size(normal.faces());
  }
  for (const v1::NetworkFace& face : proto.faces()) {
    references += size(face.vertices()) + size(face.twists()) + size(face.cuts());
  }
  for (const v1::NetworkEdge& edge : proto.edges()) {
    points +=
        (size(edge.bezier().points()) + size(edge.bspline().points()) + size(edge.hosaka().extra_terms())) /
            3 +
        edge.file().content().size() / 4;
    knots += size(edge.bspline().knots());
    references += size(edge.controls());
  }
  PM_RETURN_IF_ERROR(check("model.network.reference_count", limits::kMaxNetworkReferences, references));
  PM_RETURN_IF_ERROR(check("model.control_point_count", limits::kMaxControlPoints, points));
  return check("model.knot_count", limits::kMaxKnots, knots);
}

CurveNetwork FromProto(const v1::CurveNetwork& proto, double unit, Diagnostics& faults) {
  return NetworkReader(unit, faults).Read(proto);
}

}  // namespace patchmill
