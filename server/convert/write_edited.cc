#include "server/convert/write_edited.h"

#include <algorithm>
#include <type_traits>
#include <variant>
#include <vector>

namespace patchmill {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

void Put(const Vec3& v, Numbers* to) {
  to->Clear();
  for (int k = 0; k < 3; ++k) to->Add(v[k]);
}

bool Same(const std::vector<NetworkVertex::Normal>& a, const std::vector<NetworkVertex::Normal>& b) {
  return std::ranges::equal(
      a, b, [](const auto& x, const auto& y) { return x.direction == y.direction && x.faces == y.faces; });
}
bool Same(const std::vector<SideTwists>& a, const std::vector<SideTwists>& b) {
  return std::ranges::equal(a, b, [](const SideTwists& x, const SideTwists& y) {
    return x.start == y.start && x.end == y.end && x.at_start == y.at_start && x.at_end == y.at_end;
  });
}
bool Same(const HermiteCurve& a, const HermiteCurve& b) {
  return a.p0 == b.p0 && a.d0 == b.d0 && a.p1 == b.p1 && a.d1 == b.d1;
}
bool Same(const BezierCurve& a, const BezierCurve& b) { return a.points == b.points; }
bool Same(const BsplineCurve& a, const BsplineCurve& b) {
  return a.degree == b.degree && a.knots == b.knots && a.points == b.points;
}
bool Same(const HosakaSegment& a, const HosakaSegment& b) {
  return a.origin == b.origin && a.a == b.a && a.b == b.b && a.c == b.c && a.extra == b.extra;
}

// Whether an edit has left the shape as it was. Edits change tangents and curves only.
bool Same(const EdgeShape& a, const EdgeShape& b) {
  if (a.index() != b.index()) return false;
  if (const auto* tangents = std::get_if<TangentsEdge>(&a)) {
    const auto& other = std::get<TangentsEdge>(b);
    return tangents->start == other.start && tangents->end == other.end;
  }
  const auto* curve = std::get_if<CurveEdge>(&a);
  if (curve == nullptr) return true;
  const Curve& other = std::get<CurveEdge>(b).curve;
  if (curve->curve.index() != other.index()) return false;
  return std::visit([&](const auto& c) { return Same(c, std::get<std::decay_t<decltype(c)>>(other)); },
                    curve->curve);
}

void AddPoints(const std::vector<Vec3>& points, double unit, Numbers* to) {
  for (const Vec3& p : points) {
    for (int k = 0; k < 3; ++k) to->Add(p[k] / unit);
  }
}

void WriteShape(const EdgeShape& shape, double unit, v1::NetworkEdge& to) {
  if (const auto* tangents = std::get_if<TangentsEdge>(&shape)) {
    Put(tangents->start / unit, to.mutable_from_tangents()->mutable_start_tangent());
    Put(tangents->end / unit, to.mutable_from_tangents()->mutable_end_tangent());
    return;
  }
  const auto* given = std::get_if<CurveEdge>(&shape);
  if (given == nullptr) return;
  if (const auto* spline = std::get_if<BsplineCurve>(&given->curve)) {
    v1::BsplineCurve& made = *to.mutable_bspline();
    made.Clear();
    made.set_degree(spline->degree);
    made.mutable_knots()->Add(spline->knots.begin(), spline->knots.end());
    AddPoints(spline->points, unit, made.mutable_points());
    return;
  }
  const auto bezier = ToBezier(given->curve);
  if (!bezier.ok()) return;  // no other curve has several spans
  to.mutable_bezier()->clear_points();
  AddPoints(bezier->points, unit, to.mutable_bezier()->mutable_points());
}

// Edits change edges, add others at the end and remove some. `origins`: see WriteEdited.
void WriteEdges(const CurveNetwork& before, const CurveNetwork& after, const EditedFrom& origins,
                v1::CurveNetwork* proto) {
  google::protobuf::RepeatedPtrField<v1::NetworkEdge> list;
  for (std::size_t k = 0; k < after.edges.size(); ++k) {
    const NetworkEdge& edge = after.edges[k];
    int from = k < before.edges.size() ? static_cast<int>(k) : -1;
    if (!origins.edges.empty()) from = origins.edges[k];
    const NetworkEdge* old = from >= 0 ? &before.edges[static_cast<std::size_t>(from)] : nullptr;
    v1::NetworkEdge& to = *list.Add();
    if (old != nullptr) to.Swap(proto->mutable_edges(from));
    const bool same = old != nullptr && Same(old->shape, edge.shape);
    if (same && old->start == edge.start && old->end == edge.end && old->crease == edge.crease) continue;
    to.set_start(edge.start);
    to.set_end(edge.end);
    to.set_crease(edge.crease);
    if (!same) WriteShape(edge.shape, origins.unit, to);
  }
  proto->mutable_edges()->Swap(&list);
}

// Edits may remove lines; the others keep their order.
void WriteLines(const CurveNetwork& after, v1::CurveNetwork* proto) {
  if (static_cast<int>(after.lines.size()) == proto->lines_size()) return;
  google::protobuf::RepeatedPtrField<v1::NetworkLine> kept;
  std::size_t next = 0;
  for (const v1::NetworkLine& line : proto->lines()) {
    if (next == after.lines.size() || !std::ranges::equal(after.lines[next].vertices, line.vertices()))
      continue;
    *kept.Add() = line;
    ++next;
  }
  proto->mutable_lines()->Swap(&kept);
}

// Edits move vertices and turn normals; new vertices come last.
void WriteVertices(const CurveNetwork& before, const CurveNetwork& after, double unit,
                   v1::CurveNetwork* proto) {
  for (std::size_t k = 0; k < after.vertices.size(); ++k) {
    const NetworkVertex& vertex = after.vertices[k];
    const NetworkVertex* old = k < before.vertices.size() ? &before.vertices[k] : nullptr;
    v1::NetworkVertex& to =
        old != nullptr ? *proto->mutable_vertices(static_cast<int>(k)) : *proto->add_vertices();
    if (old == nullptr || old->position != vertex.position)
      Put(vertex.position / unit, to.mutable_position());
    if (old != nullptr && Same(old->normals, vertex.normals)) continue;
    to.clear_normals();
    for (const NetworkVertex::Normal& normal : vertex.normals) {
      v1::VertexNormal& made = *to.add_normals();
      Put(normal.direction, made.mutable_direction());
      made.mutable_faces()->Add(normal.faces.begin(), normal.faces.end());
    }
  }
}

v1::PatchScheme SchemeOf(PatchScheme scheme) {
  switch (scheme) {
    case PatchScheme::kAuto:
      return v1::PATCH_SCHEME_UNSPECIFIED;
    case PatchScheme::kGregory:
      return v1::PATCH_SCHEME_GREGORY;
    case PatchScheme::kBrown:
      return v1::PATCH_SCHEME_BROWN;
    case PatchScheme::kLoftTriangle:
      return v1::PATCH_SCHEME_LOFT_TRIANGLE;
    case PatchScheme::kGregoryTriangle:
      return v1::PATCH_SCHEME_GREGORY_TRIANGLE;
    case PatchScheme::kG2Gregory:
      return v1::PATCH_SCHEME_G2_GREGORY;
    case PatchScheme::kHosaka:
      return v1::PATCH_SCHEME_HOSAKA;
  }
  return v1::PATCH_SCHEME_UNSPECIFIED;
}

void WritePushes(const std::vector<FacePush>& was, const std::vector<FacePush>& is, double unit,
                 v1::NetworkFace& face) {
  if (was == is) return;
  std::size_t first = was.size();  // those that stay keep their bits
  if (was.size() > is.size() || !std::equal(was.begin(), was.end(), is.begin())) {
    face.clear_push();
    face.clear_more_pushes();
    first = 0;
  }
  for (std::size_t k = first; k < is.size(); ++k) {
    v1::FacePush& to = k == 0 ? *face.mutable_push() : *face.add_more_pushes();
    to.set_u(is[k].u);
    to.set_v(is[k].v);
    to.set_amount(is[k].amount * unit);
  }
}

// Edits change faces in their places and add others at the end.
void WriteFaces(const CurveNetwork& before, const CurveNetwork& after, double unit, v1::CurveNetwork* proto) {
  const NetworkFace none;
  for (std::size_t k = 0; k < after.faces.size(); ++k) {
    const NetworkFace& face = after.faces[k];
    const bool fresh = k >= before.faces.size();
    const NetworkFace& old = fresh ? none : before.faces[k];
    v1::NetworkFace& to = fresh ? *proto->add_faces() : *proto->mutable_faces(static_cast<int>(k));
    if (fresh) {
      to.set_id(face.id);
      to.set_scheme(SchemeOf(face.scheme));
    }
    if (old.vertices != face.vertices) {
      to.clear_vertices();
      to.mutable_vertices()->Add(face.vertices.begin(), face.vertices.end());
    }
    WritePushes(old.pushes, face.pushes, unit, to);
    if (old.bulges != face.bulges) {
      to.clear_bulges();
      for (const Bulge& bulge : face.bulges) {
        v1::Bulge& made = *to.add_bulges();
        made.set_u(bulge.u);
        made.set_v(bulge.v);
        Put(bulge.by / unit, made.mutable_by());
      }
    }
    if (!Same(old.twists, face.twists)) {
      to.clear_twists();
      for (const SideTwists& twists : face.twists) {
        v1::SideTwists& made = *to.add_twists();
        made.set_start(twists.start);
        made.set_end(twists.end);
        if (twists.at_start) Put(*twists.at_start / unit, made.mutable_start_twist());
        if (twists.at_end) Put(*twists.at_end / unit, made.mutable_end_twist());
      }
    }
    if (old.cuts == face.cuts) continue;
    to.clear_cuts();
    for (std::size_t c = 0; c < face.cuts.size(); ++c) {
      v1::FaceCut& cut = *to.add_cuts();
      cut.set_start(face.cuts[c][0]);
      cut.set_end(face.cuts[c][1]);
    }
  }
}

void WriteControls(const CurveNetwork& before, const CurveNetwork& after, double unit,
                   v1::CurveNetwork* proto) {
  if (before.controls == after.controls) return;
  std::vector<v1::EdgeControl> given;  // in the order of before.controls: those of edges, then the others
  for (v1::NetworkEdge& edge : *proto->mutable_edges()) {
    for (const v1::CrossControl& control : edge.controls()) {
      v1::EdgeControl& to = given.emplace_back();
      to.set_start(edge.start());
      to.set_end(edge.end());
      *to.mutable_control() = control;
    }
    edge.clear_controls();
  }
  given.insert(given.end(), proto->controls().begin(), proto->controls().end());
  proto->clear_controls();
  std::size_t from = 0;
  for (const CrossControl& control : after.controls) {
    const auto same_place = [&](const CrossControl& old) {
      return old.start == control.start && old.end == control.end && old.face == control.face;
    };
    std::size_t k = from;  // controls that stay keep their order
    while (k < before.controls.size() && !same_place(before.controls[k])) ++k;
    if (k < before.controls.size()) {
      from = k + 1;
      if (before.controls[k] == control) {
        *proto->add_controls() = given[k];
        continue;
      }
    }
    v1::EdgeControl& to = *proto->add_controls();
    to.set_start(control.start);
    to.set_end(control.end);
    to.mutable_control()->set_face(control.face);
    if (control.first) Put(*control.first / unit, to.mutable_control()->mutable_first_derivative());
    if (control.second) Put(*control.second / unit, to.mutable_control()->mutable_second_derivative());
  }
}

}  // namespace

void WriteEdited(const CurveNetwork& before, const CurveNetwork& after, const EditedFrom& origins,
                 v1::CurveNetwork* proto) {
  WriteVertices(before, after, origins.unit, proto);
  WriteFaces(before, after, origins.unit, proto);
  WriteControls(before, after, origins.unit, proto);  // reads the edges as they were
  WriteEdges(before, after, origins, proto);
  WriteLines(after, proto);
}

}  // namespace patchmill
