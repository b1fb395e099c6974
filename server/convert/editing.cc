#include "server/convert/editing.h"

#include <algorithm>
#include <optional>

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

void WriteEdited(const CurveNetwork& before, const CurveNetwork& after, double unit,
                 v1::CurveNetwork* proto) {
  for (int i = 0; i < proto->vertices_size(); ++i) {
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
