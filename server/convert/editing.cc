#include "server/convert/editing.h"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <variant>

#include <absl/strings/match.h>
#include <absl/strings/numbers.h>
#include <fmt/format.h>

#include "core/base/status.h"
#include "server/convert/fields.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

class EditReader {
 public:
  EditReader(double unit, FieldErrors& errors) : unit_(unit), errors_(errors) {}

  NetworkEdit Read(const v1::ModelEdit& edit, const std::string& at) {
    switch (edit.edit_case()) {
      case v1::ModelEdit::kPushFace:
        return Push(edit.push_face(), At(at, "push_face"));
      case v1::ModelEdit::kTurnNormal:
        return Normal(edit.turn_normal(), At(at, "turn_normal"));
      case v1::ModelEdit::kSetControl:
        return Control(edit.set_control(), At(at, "set_control"));
      case v1::ModelEdit::kMoveControlPoint:
        return ControlPoint(edit.move_control_point(), At(at, "move_control_point"));
      case v1::ModelEdit::kBendSection:
        return CurvatureEdit{EdgeOf(edit.bend_section()), edit.bend_section().curvature() / unit_};
      case v1::ModelEdit::kGuideRow:
        return Guide(edit.guide_row(), At(at, "guide_row"));
      case v1::ModelEdit::kReachGoals:
        return Reach(edit.reach_goals(), At(at, "reach_goals"));
      case v1::ModelEdit::kMoveVertex:
        return MoveVertex(edit.move_vertex(), At(at, "move_vertex"));
      case v1::ModelEdit::kSetCrease:
        return CreaseEdit{edit.set_crease().start(), edit.set_crease().end(), edit.set_crease().crease()};
      case v1::ModelEdit::EDIT_NOT_SET:
        break;
    }
    errors_.Missing(at);
    return PushEdit{};
  }

 private:
  Vec3 Vector(const Numbers& numbers, double factor, const std::string& field) {
    if (numbers.size() == 3) return factor * Vec3(numbers[0], numbers[1], numbers[2]);
    errors_.Add(field, fmt::format("has {} numbers; must have x y z", numbers.size()));
    return Vec3::Zero();
  }
  std::optional<Vec3> Optional(const Numbers& numbers, double factor, const std::string& field) {
    return numbers.empty() ? std::nullopt : std::optional(Vector(numbers, factor, field));
  }

  template <class Edit>
  static EdgeOfFace EdgeOf(const Edit& edit) {
    return {edit.start(), edit.end(), edit.face()};
  }

  NetworkEdit Push(const v1::PushFace& from, const std::string& at) {
    if (!from.has_push()) errors_.Missing(At(at, "push"));
    return PushEdit{from.face(), {from.push().u(), from.push().v(), from.push().amount() / unit_}};
  }

  NetworkEdit Normal(const v1::TurnNormal& from, const std::string& at) {
    NormalEdit edit{from.vertex(), {}, Vector(from.direction(), 1.0, At(at, "direction"))};
    if (from.has_face()) edit.face = from.face();
    return edit;
  }

  struct Field {
    const char* name;
    bool given;
  };
  // Exactly one of two fields must be given.
  void OneOf(const std::string& at, const Field& first, const Field& second) {
    if (first.given != second.given) return;
    errors_.Add(at, fmt::format("has {} {} {} {}; must have one of them", first.given ? "both" : "neither",
                                first.name, first.given ? "and" : "nor", second.name));
  }

  NetworkEdit Reach(const v1::ReachGoals& from, const std::string& at) {
    ReachEdit edit;
    for (int k = 0; k < from.points_size(); ++k) {
      const v1::PointGoal& goal = from.points(k);
      const std::string field = fmt::format("{}.points[{}]", at, k);
      OneOf(field, {"distance", goal.has_distance()}, {"to", !goal.to().empty()});
      edit.goals.points.push_back({goal.face(), goal.u(), goal.v(),
                                   Optional(goal.near(), unit_, At(field, "near")), unit_ * goal.distance(),
                                   Optional(goal.to(), unit_, At(field, "to"))});
    }
    for (int k = 0; k < from.edges_size(); ++k) {
      const v1::EdgeGoal& goal = from.edges(k);
      EdgeGoal& to = edit.goals.edges.emplace_back();
      to.start = goal.start(), to.end = goal.end();
      if (goal.has_parameter()) to.parameter = goal.parameter();
      to.through = Vector(goal.through(), unit_, fmt::format("{}.edges[{}].through", at, k));
    }
    for (const v1::FullnessGoal& goal : from.fullness()) {
      edit.goals.fullness.push_back({goal.face(), goal.fullness()});
    }
    return edit;
  }

  NetworkEdit MoveVertex(const v1::MoveVertex& from, const std::string& at) {
    OneOf(at, {"position", !from.position().empty()}, {"by", !from.by().empty()});
    if (from.by().empty() && from.position().empty()) return VertexEdit{};
    const bool by = !from.by().empty();
    return VertexEdit{from.vertex(),
                      Vector(by ? from.by() : from.position(), unit_, At(at, by ? "by" : "position")), by};
  }

  NetworkEdit Control(const v1::EdgeControl& from, const std::string& at) {
    if (!from.has_control()) errors_.Missing(At(at, "control"));
    const v1::CrossControl& control = from.control();
    return ControlEdit{{from.start(), from.end(), control.face(),
                        Optional(control.first_derivative(), unit_, At(at, "control.first_derivative")),
                        Optional(control.second_derivative(), unit_, At(at, "control.second_derivative"))}};
  }

  NetworkEdit ControlPoint(const v1::MoveControlPoint& from, const std::string& at) {
    return ControlPointEdit{EdgeOf(from), from.point(), Vector(from.position(), unit_, At(at, "position"))};
  }

  NetworkEdit Guide(const v1::GuideRow& from, const std::string& at) {
    GuideEdit edit;
    for (const v1::VertexPair& pair : from.edges()) edit.edges.push_back({pair.start(), pair.end()});
    edit.closed = from.closed();
    edit.start = Optional(from.start_direction(), 1.0, At(at, "start_direction"));
    edit.end = Optional(from.end_direction(), 1.0, At(at, "end_direction"));
    return edit;
  }

  double unit_;
  FieldErrors& errors_;
};

void Put(const Vec3& v, Numbers* to) {
  to->Clear();
  for (int k = 0; k < 3; ++k) to->Add(v[k]);
}

bool Same(const std::vector<NetworkVertex::Normal>& a, const std::vector<NetworkVertex::Normal>& b) {
  return std::ranges::equal(
      a, b, [](const auto& x, const auto& y) { return x.direction == y.direction && x.faces == y.faces; });
}

}  // namespace

absl::StatusOr<std::vector<NetworkEdit>> FromProto(
    const google::protobuf::RepeatedPtrField<v1::ModelEdit>& edits, double unit) {
  if (edits.size() > kMaxEdits) {
    return LimitError("edits", static_cast<double>(kMaxEdits), static_cast<double>(edits.size()));
  }
  FieldErrors errors;
  EditReader reader(unit, errors);
  std::vector<NetworkEdit> list;
  for (int k = 0; k < edits.size(); ++k) list.push_back(reader.Read(edits[k], fmt::format("edits[{}]", k)));
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return list;
}

namespace {

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

// Edits change edges in their places and add others at the end.
void WriteEdges(const CurveNetwork& before, const CurveNetwork& after, double unit, v1::CurveNetwork* proto) {
  for (std::size_t k = 0; k < after.edges.size(); ++k) {
    const NetworkEdge& edge = after.edges[k];
    const NetworkEdge* old = k < before.edges.size() ? &before.edges[k] : nullptr;
    if (old != nullptr && old->start == edge.start && old->end == edge.end && old->crease == edge.crease &&
        Same(old->shape, edge.shape)) {
      continue;
    }
    v1::NetworkEdge& to = old != nullptr ? *proto->mutable_edges(static_cast<int>(k)) : *proto->add_edges();
    to.set_start(edge.start);
    to.set_end(edge.end);
    to.set_crease(edge.crease);
    if (old == nullptr || !Same(old->shape, edge.shape)) WriteShape(edge.shape, unit, to);
  }
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

}  // namespace

void WriteEdited(const CurveNetwork& before, const CurveNetwork& after, double unit,
                 v1::CurveNetwork* proto) {
  for (int i = 0; i < proto->vertices_size(); ++i) {
    const Vec3 &was = before.vertices[static_cast<std::size_t>(i)].position,
               &is = after.vertices[static_cast<std::size_t>(i)].position;
    if (was != is) Put(is / unit, proto->mutable_vertices(i)->mutable_position());
    const auto& normals = after.vertices[static_cast<std::size_t>(i)].normals;
    if (Same(before.vertices[static_cast<std::size_t>(i)].normals, normals)) continue;
    auto* list = proto->mutable_vertices(i)->mutable_normals();
    list->Clear();
    for (const NetworkVertex::Normal& normal : normals) {
      v1::VertexNormal& to = *list->Add();
      Put(normal.direction, to.mutable_direction());
      to.mutable_faces()->Add(normal.faces.begin(), normal.faces.end());
    }
  }
  for (int i = 0; i < proto->faces_size(); ++i) {
    const auto &old = before.faces[static_cast<std::size_t>(i)].pushes,
               &pushes = after.faces[static_cast<std::size_t>(i)].pushes;
    for (std::size_t k = old.size(); k < pushes.size(); ++k) {  // edits add pushes at the end
      v1::NetworkFace& face = *proto->mutable_faces(i);
      v1::FacePush& to = k == 0 ? *face.mutable_push() : *face.add_more_pushes();
      to.set_u(pushes[k].u);
      to.set_v(pushes[k].v);
      to.set_amount(pushes[k].amount * unit);
    }
  }
  for (int i = 0; i < proto->faces_size(); ++i) {
    const auto &was = before.faces[static_cast<std::size_t>(i)].bulges,
               &is = after.faces[static_cast<std::size_t>(i)].bulges;
    if (was == is) continue;
    auto* list = proto->mutable_faces(i)->mutable_bulges();
    list->Clear();
    for (const Bulge& bulge : is) {
      v1::Bulge& to = *list->Add();
      to.set_u(bulge.u);
      to.set_v(bulge.v);
      Put(bulge.by / unit, to.mutable_by());
    }
  }
  WriteEdges(before, after, unit, proto);
  WriteLines(after, proto);
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

namespace {

// "edits[k]" and the rest of a path as "edits[k].KIND" and the rest.
std::string RequestPath(const std::string& path,
                        const google::protobuf::RepeatedPtrField<v1::ModelEdit>& edits) {
  const std::size_t close = path.find(']');
  int k = -1;
  if (close == path.npos || !absl::SimpleAtoi(path.substr(6, close - 6), &k) || k < 0 || k >= edits.size()) {
    return path;
  }
  const v1::ModelEdit& edit = edits[k];
  const auto* kind = edit.GetReflection()->GetOneofFieldDescriptor(edit, edit.GetDescriptor()->oneof_decl(0));
  if (kind == nullptr) return path;
  return fmt::format("edits[{}].{}{}", k, std::string(kind->name()), path.substr(close + 1));
}

}  // namespace

void AddReached(const EditedNetwork& edited, double unit,
                google::protobuf::RepeatedPtrField<v1::ReachedGoal>* to) {
  for (const ReachedGoal& goal : edited.reached) {
    v1::ReachedGoal& made = *to->Add();
    const char* list = goal.kind == GoalKind::kPoint  ? "points"
                       : goal.kind == GoalKind::kEdge ? "edges"
                                                      : "fullness";
    made.set_field(fmt::format("edits[{}].reach_goals.{}[{}]", goal.edit, list, goal.goal));
    Put(goal.target / unit, made.mutable_target());
    Put(goal.reached / unit, made.mutable_reached());
    made.set_distance(goal.distance / unit);
    made.set_missed(goal.missed);
    made.set_u(goal.place.x());
    made.set_v(goal.place.y());
  }
}

Diagnostics GoalFindings(const EditedNetwork& edited,
                         const google::protobuf::RepeatedPtrField<v1::ModelEdit>& edits) {
  Diagnostics findings = edited.findings;
  for (Diagnostic& finding : findings) {
    const std::string path = RequestPath(finding.where.field, edits);
    if (finding.message.starts_with(finding.where.field)) {
      finding.message.replace(0, finding.where.field.size(), path);
    }
    finding.where.field = path;
  }
  return findings;
}

absl::Status WithFieldPath(const absl::Status& status,
                           const google::protobuf::RepeatedPtrField<v1::ModelEdit>& edits) {
  constexpr absl::string_view kBegin = "edits[";
  const absl::string_view message = status.message();
  if (!absl::IsInvalidArgument(status) || !absl::StartsWith(message, kBegin)) return status;
  const std::size_t close = message.find(']'), space = message.find(' ');
  int k = -1;
  if (close == message.npos || space == message.npos || space < close ||
      !absl::SimpleAtoi(message.substr(kBegin.size(), close - kBegin.size()), &k) || k < 0 ||
      k >= edits.size()) {
    return status;
  }
  const v1::ModelEdit& edit = edits[k];
  const auto* kind = edit.GetReflection()->GetOneofFieldDescriptor(edit, edit.GetDescriptor()->oneof_decl(0));
  if (kind == nullptr) return status;
  std::string field(message.substr(close + 1, space - close - 1));
  // Fields whose path in the message differs from that in the edit.
  if (edit.has_set_control() && field == ".face") field = ".control.face";
  if (edit.has_guide_row() && (field == ".start" || field == ".end")) field += "_direction";
  FieldErrors errors;
  errors.Add(fmt::format("edits[{}].{}{}", k, std::string(kind->name()), field),
             std::string(message.substr(space + 1)));
  return errors.ToStatus();
}

}  // namespace patchmill
