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
      case v1::ModelEdit::kReachGoals:
        return Reach(edit.reach_goals(), At(at, "reach_goals"));
      case v1::ModelEdit::kMoveVertex:
        return MoveVertex(edit.move_vertex(), At(at, "move_vertex"));
      case v1::ModelEdit::kSetCrease:
        return CreaseEdit{edit.set_crease().start(), edit.set_crease().end(), edit.set_crease().crease()};
      case v1::ModelEdit::kSplitFaces: {
        const v1::SplitFaces& split = edit.split_faces();
        return SplitEdit{{split.start(), split.end(), split.has_parameter() ? split.parameter() : 0.5}};
      }
      case v1::ModelEdit::kCutFace:
        return CutEdit{edit.cut_face().face(),
                       {edit.cut_face().start(), edit.cut_face().end()},
                       edit.cut_face().remove()};
      case v1::ModelEdit::kFitPoints:
        return Fit(edit.fit_points(), At(at, "fit_points"));
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

  NetworkEdit Fit(const v1::FitPoints& from, const std::string& at) {
    FitEdit edit;
    if (from.points_size() % 3 != 0) {
      errors_.Add(At(at, "points"), fmt::format("has {} numbers; must be packed x y z", from.points_size()));
    }
    for (int k = 0; k + 2 < from.points_size(); k += 3) {
      edit.fit.points.push_back(unit_ * Vec3(from.points(k), from.points(k + 1), from.points(k + 2)));
    }
    edit.fit.band = unit_ * from.band();
    edit.fit.normals = !from.keep_normals();
    edit.fit.middles = !from.keep_middles();
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

namespace {

const char* ListOf(GoalKind kind) {
  switch (kind) {
    case GoalKind::kPoint:
      return "reach_goals.points";
    case GoalKind::kEdge:
      return "reach_goals.edges";
    case GoalKind::kFullness:
      return "reach_goals.fullness";
    case GoalKind::kFit:
      return "fit_points.points";
  }
  return "";
}

}  // namespace

void AddReached(const EditedNetwork& edited, double unit,
                google::protobuf::RepeatedPtrField<v1::ReachedGoal>* to) {
  for (const ReachedGoal& goal : edited.reached) {
    v1::ReachedGoal& made = *to->Add();
    made.set_field(fmt::format("edits[{}].{}[{}]", goal.edit, ListOf(goal.kind), goal.goal));
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
