#include "server/convert/network_message.h"

namespace patchmill {
namespace {

using Doubles = google::protobuf::RepeatedField<double>;

void AddVector(const Vec3& v, Doubles* to) {
  for (int k = 0; k < 3; ++k) to->Add(v[k]);
}

struct ShapeWriter {
  v1::NetworkEdge& to;
  double unit = 1.0;  // mm

  void operator()(const NormalsEdge& edge) const {
    if (edge.gamma != 1.0) to.mutable_from_normals()->set_gamma(edge.gamma);
  }
  void operator()(const TangentsEdge& edge) const {
    AddVector(edge.start, to.mutable_from_tangents()->mutable_start_tangent());
    AddVector(edge.end, to.mutable_from_tangents()->mutable_end_tangent());
  }
  void operator()(const CurveEdge& edge) const {
    if (const auto* bspline = std::get_if<BsplineCurve>(&edge.curve)) {
      v1::BsplineCurve& curve = *to.mutable_bspline();
      curve.set_degree(bspline->degree);
      curve.mutable_knots()->Add(bspline->knots.begin(), bspline->knots.end());
      for (const Vec3& p : bspline->points) AddVector(p / unit, curve.mutable_points());
      return;
    }
    const auto bezier = ToBezier(edge.curve);
    if (!bezier.ok()) return;
    for (const Vec3& p : bezier->points) AddVector(p / unit, to.mutable_bezier()->mutable_points());
  }
  template <class Shape>
  void operator()(const Shape&) const {}  // not made here
};

}  // namespace

v1::CurveNetwork ToProto(const CurveNetwork& network) {
  v1::CurveNetwork proto;
  for (const NetworkVertex& vertex : network.vertices) {
    v1::NetworkVertex& to = *proto.add_vertices();
    to.set_id(vertex.id);
    AddVector(vertex.position, to.mutable_position());
    for (const NetworkVertex::Normal& normal : vertex.normals) {
      v1::VertexNormal& n = *to.add_normals();
      AddVector(normal.direction, n.mutable_direction());
      n.mutable_faces()->Add(normal.faces.begin(), normal.faces.end());
    }
  }
  for (const NetworkEdge& edge : network.edges) {
    v1::NetworkEdge& to = *proto.add_edges();
    to.set_id(edge.id);
    to.set_start(edge.start);
    to.set_end(edge.end);
    to.set_crease(edge.crease);
    std::visit(ShapeWriter{to}, edge.shape);
  }
  for (const NetworkFace& face : network.faces) {
    v1::NetworkFace& to = *proto.add_faces();
    to.set_id(face.id);
    to.mutable_vertices()->Add(face.vertices.begin(), face.vertices.end());
    for (const SideTwists& twists : face.twists) {
      v1::SideTwists& t = *to.add_twists();
      t.set_start(twists.start);
      t.set_end(twists.end);
      if (twists.at_start) AddVector(*twists.at_start, t.mutable_start_twist());
      if (twists.at_end) AddVector(*twists.at_end, t.mutable_end_twist());
    }
  }
  return proto;
}

void PutCurvesInPlace(const CurveNetwork& network, double unit, v1::CurveNetwork* proto) {
  for (int e = 0; e < proto->edges_size(); ++e) {
    v1::NetworkEdge& edge = *proto->mutable_edges(e);
    if (edge.shape_case() != v1::NetworkEdge::kFile) continue;
    edge.clear_shape();
    std::visit(ShapeWriter{edge, unit}, network.edges[static_cast<std::size_t>(e)].shape);
  }
}

}  // namespace patchmill
