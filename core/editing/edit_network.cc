#include "core/editing/edit_network.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/editing/control_store.h"
#include "core/editing/guide_curve.h"
#include "core/editing/move_vertex.h"
#include "core/editing/reach_edges.h"
#include "core/editing/reach_points.h"
#include "core/editing/section_points.h"
#include "core/joining/join_network.h"
#include "core/joining/line_edges.h"
#include "core/network/control_points.h"

namespace patchmill {
namespace {

constexpr std::size_t kMaxFindings = 1000;

bool SameEdge(int a, int b, int c, int d) { return std::minmax(a, b) == std::minmax(c, d); }

class Editor {
 public:
  Editor(CurveNetwork network, const JoinedNetwork* joined, const RunContext& run)
      : network_(std::move(network)), run_(run), given_(joined) {
    for (std::size_t k = 0; k < network_.edges.size(); ++k) edge_of_.push_back(static_cast<int>(k));
  }

  absl::Status ReadControls() { return controls_.Read(network_.controls); }

  EditedNetwork Take() {
    network_.controls = controls_.List();
    edge_of_.resize(network_.edges.size(), -1);
    return {std::move(network_), std::move(edge_of_), std::move(reached_), std::move(findings_)};
  }
  void Begin(int edit) { edit_ = edit; }

  absl::Status Apply(const PushEdit& edit, const std::string& at) {
    PM_RETURN_IF_ERROR(CheckFace(edit.face, at));
    if (network_.faces[At(edit.face)].pushes.size() >= kMaxFacePushes) {
      return Error(at + ".face",
                   fmt::format("= {}; has {} pushes already, which is the most", edit.face, kMaxFacePushes));
    }
    network_.faces[At(edit.face)].pushes.push_back(edit.push);
    return Changed();
  }

  absl::Status Apply(const NormalEdit& edit, const std::string& at) {
    PM_RETURN_IF_ERROR(CheckVertex(edit.vertex, at));
    if (!edit.direction.allFinite() || !(edit.direction.norm() > 1e-12)) {
      return Error(at + ".direction", "has no direction; must be finite and not zero");
    }
    auto& normals = network_.vertices[At(edit.vertex)].normals;
    if (!edit.face) {
      if (normals.size() > 1) {
        return Error(at + ".face",
                     fmt::format("is missing; vertex {} has {} normals, one for each group of faces",
                                 edit.vertex, normals.size()));
      }
      const std::vector<int> faces = normals.empty() ? std::vector<int>() : normals[0].faces;
      normals = {{edit.direction, faces}};
      return Changed();
    }
    PM_RETURN_IF_ERROR(CheckFace(*edit.face, at));
    NetworkVertex::Normal* serving = nullptr;
    for (auto& normal : normals) {
      const bool listed = std::ranges::count(normal.faces, *edit.face) > 0;
      if (listed || (normal.faces.empty() && serving == nullptr)) serving = &normal;
    }
    if (serving != nullptr) {
      serving->direction = edit.direction;
      return Changed();
    }
    PM_ASSIGN_OR_RETURN(const std::vector<int> faces, Group(edit.vertex, *edit.face, at));
    normals.push_back({edit.direction, faces});
    return Changed();
  }

  absl::Status Apply(const VertexEdit& edit, const std::string& at) {
    PM_RETURN_IF_ERROR(CheckVertex(edit.vertex, at));
    if (!edit.position.allFinite()) return Error(at + (edit.by ? ".by" : ".position"), "must be finite");
    const NetworkVertex& vertex = network_.vertices[At(edit.vertex)];
    if (vertex.on_edge) {
      return Error(at + ".vertex", fmt::format("= {}; lies on the edge {} {} and moves with it", edit.vertex,
                                               vertex.on_edge->start, vertex.on_edge->end));
    }
    MoveVertexTo(network_, edit.vertex, edit.by ? Vec3(vertex.position + edit.position) : edit.position);
    return Changed();
  }

  absl::Status Apply(const CreaseEdit& edit, const std::string& at) {
    PM_RETURN_IF_ERROR(Join(at));
    const auto found = std::ranges::find_if(joined_->edges, [&](const JoinedEdge& e) {
      return SameEdge(e.topology.start, e.topology.end, edit.start, edit.end);
    });
    if (found == joined_->edges.end()) {
      return Error(at, fmt::format("names the edge {} {}; there is no such edge", edit.start, edit.end));
    }
    if (found->topology.part) {
      const TableEdge& whole = joined_->edges[At(found->topology.part->whole)].topology;
      return Error(at, fmt::format("names the edge {} {}, which is a part of the edge {} {}; name that one",
                                   edit.start, edit.end, whole.start, whole.end));
    }
    if (found->topology.crease == edit.crease) return absl::OkStatus();
    if (!edit.crease && found->topology.faces.size() == 2) {
      ShareNormals(found->topology);
    }
    FreeLinesOf(edit.start, edit.end);
    for (NetworkEdge& edge : network_.edges) {
      if (!SameEdge(edge.start, edge.end, edit.start, edit.end)) continue;
      edge.crease = edit.crease;
      return Changed();
    }
    NetworkEdge& edge = network_.edges.emplace_back();
    edge.start = edit.start, edge.end = edit.end, edge.crease = edit.crease;
    return Changed();
  }

  absl::Status Apply(const SplitEdit& edit, const std::string& at) {
    PM_RETURN_IF_ERROR(Join(at));
    PM_ASSIGN_OR_RETURN(const std::vector<int> crossed, CrossedEdges(edit.split, *joined_, network_, at));
    const JoinedNetwork before = *joined_;
    for (const int e : crossed) {
      const TableEdge& edge = before.edges[At(e)].topology;
      FreeLinesOf(edge.start, edge.end);
    }
    network_.controls = controls_.List();
    PM_ASSIGN_OR_RETURN(const std::vector<DividedFace> divided, SplitFaces(edit.split, before, at, network_));
    controls_ = ControlStore();
    PM_RETURN_IF_ERROR(controls_.Read(network_.controls));
    PM_RETURN_IF_ERROR(Changed());
    PM_RETURN_IF_ERROR(Join(at));
    const double change = LargestChange(divided, before);
    findings_.push_back(MakeInfo("FACES_SPLIT",
                                 fmt::format("{} makes {} faces of {}; the surface changes by up to {:.3g}",
                                             at, 2 * divided.size(), divided.size(), change),
                                 {.field = at}));
    return absl::OkStatus();
  }

  absl::Status Apply(const CutEdit& edit, const std::string& at) {
    PM_RETURN_IF_ERROR(CheckFace(edit.face, at));
    NetworkFace& face = network_.faces[At(edit.face)];
    for (const int end : edit.ends) {
      if (std::ranges::count(face.vertices, end) > 0) continue;
      return Error(at, fmt::format("names vertex {}, which is no corner of face {}", end, edit.face));
    }
    if (!edit.remove) {
      face.cuts.push_back(edit.ends);
      return Changed();
    }
    const auto same = [&](const std::array<int, 2>& cut) {
      return SameEdge(cut[0], cut[1], edit.ends[0], edit.ends[1]);
    };
    if (std::erase_if(face.cuts, same) == 0) {
      return Error(at, fmt::format("names the edge {} {}, which is no cut of face {}", edit.ends[0],
                                   edit.ends[1], edit.face));
    }
    for (std::size_t k = network_.edges.size(); k-- > 0;) {  // its curve, if it was given
      const NetworkEdge& edge = network_.edges[k];
      if (!SameEdge(edge.start, edge.end, edit.ends[0], edit.ends[1])) continue;
      edge_of_.resize(network_.edges.size(), -1);
      network_.edges.erase(network_.edges.begin() + static_cast<std::ptrdiff_t>(k));
      edge_of_.erase(edge_of_.begin() + static_cast<std::ptrdiff_t>(k));
    }
    return Changed();
  }

  absl::Status Apply(const FitEdit& edit, const std::string& at) {
    network_.controls = controls_.List();
    PM_ASSIGN_OR_RETURN(const auto reached, FitPoints(edit.fit, at, run_, network_));
    Report(reached, at);
    return Changed();
  }

  absl::Status Apply(const ReachEdit& edit, const std::string& at) {
    const Goals& goals = edit.goals;
    if (goals.edges.empty() && goals.points.empty() && goals.fullness.empty()) {
      return Error(at, "has no goals; give edges, points or fullness");
    }
    if (const std::size_t count = goals.edges.size() + goals.points.size() + goals.fullness.size();
        count > kMaxGoals) {
      return Error(at, fmt::format("has {} goals; at most {}", count, kMaxGoals));
    }
    PM_RETURN_IF_ERROR(Join(at));
    if (!goals.edges.empty()) {
      network_.controls = controls_.List();
      PM_ASSIGN_OR_RETURN(const auto reached, ReachEdges(goals.edges, *joined_, network_, {at, run_}));
      Report(reached, at + ".edges");
      PM_RETURN_IF_ERROR(Changed());
    }
    if (goals.points.empty() && goals.fullness.empty()) return absl::OkStatus();
    PM_RETURN_IF_ERROR(Join(at));
    PM_ASSIGN_OR_RETURN(auto reached, ReachPoints(goals, *joined_, network_.faces, at));
    std::ranges::stable_sort(reached, {}, [](const ReachedGoal& r) { return std::pair(r.kind, r.goal); });
    Report(reached, at);
    return Changed();
  }

  absl::Status Apply(const ControlEdit& edit, const std::string& at) {
    PM_RETURN_IF_ERROR(CheckSide({edit.control.start, edit.control.end, edit.control.face}, at).status());
    controls_.Set(edit.control);
    return Changed();
  }

  absl::Status Apply(const ControlPointEdit& edit, const std::string& at) {
    if (edit.point != 1 && edit.point != 2) {
      return Error(at + ".point", fmt::format("= {}; must be 1 or 2", edit.point));
    }
    PM_ASSIGN_OR_RETURN(const MiddleCross cross, CrossAt(edit.at, at));
    SectionPoints points = SectionPointsOf(cross);
    (edit.point == 1 ? points.q1 : points.q2) = edit.position;
    const MiddleCross wished = CrossOf(points);
    CrossControl control{edit.at.start, edit.at.end, edit.at.face, {}, {}};
    if (edit.point == 1) {
      controls_.DropSecond(control);  // joining finds it anew
      control.first = wished.first;
    } else {
      control.first = cross.first, control.second = wished.second;
    }
    controls_.Set(control);
    return Changed();
  }

  absl::Status Apply(const CurvatureEdit& edit, const std::string& at) {
    if (!(std::abs(edit.curvature) < kInfinity)) return Error(at + ".curvature", "must be finite");
    PM_ASSIGN_OR_RETURN(const MiddleCross cross, CrossAt(edit.at, at));
    controls_.Set(
        {edit.at.start, edit.at.end, edit.at.face, cross.first, SecondForCurvature(cross, edit.curvature)});
    return Changed();
  }

  absl::Status Apply(const GuideEdit& edit, const std::string& at) {
    const std::size_t count = edit.edges.size(), least = edit.closed ? 3 : 2;
    if (count < least) {
      return Error(at + ".edges", fmt::format("are {}; must be at least {}", count, least));
    }
    PM_RETURN_IF_ERROR(Join(at));
    for (const bool last : {false, true}) {
      const std::optional<Vec3>& given = last ? edit.end : edit.start;
      if (given && (!given->allFinite() || !(given->norm() > 0.0))) {
        return Error(at + (last ? ".end" : ".start"), "has no direction; must be finite and not zero");
      }
    }
    std::map<std::pair<int, int>, const JoinedEdge*> by_ends;
    for (const JoinedEdge& e : joined_->edges) {
      by_ends.emplace(std::minmax(e.topology.start, e.topology.end), &e);
    }
    std::vector<Vec3> middles;
    std::vector<const JoinedEdge*> row;
    for (std::size_t k = 0; k < count; ++k) {
      const auto [a, b] = edit.edges[k];
      const auto edge = by_ends.find(std::minmax(a, b));
      if (edge == by_ends.end()) {
        return Error(fmt::format("{}.edges[{}]", at, k), fmt::format("= {} {}; there is no such edge", a, b));
      }
      row.push_back(edge->second);
      middles.push_back(Evaluate(edge->second->curve, kControlPlace).p);
    }
    const std::size_t spans = edit.closed ? count : count - 1;
    std::vector<int> faces;
    for (std::size_t k = 0; k < spans; ++k) {
      const auto& next = edit.edges[(k + 1) % count];
      const std::optional<int> face = FaceBetween(row[k]->topology, next);
      if (!face) {
        return Error(fmt::format("{}.edges[{}]", at, k),
                     fmt::format("= {} {}; must lie opposite to the edge {} {} of one G2-Gregory face",
                                 edit.edges[k][0], edit.edges[k][1], next[0], next[1]));
      }
      faces.push_back(*face);
    }
    std::vector<GuideSpan> row_spans;
    for (std::size_t k = 0; k < spans; ++k) {
      const auto& [a, b] = edit.edges[k];
      const auto& [c, d] = edit.edges[(k + 1) % count];
      PM_ASSIGN_OR_RETURN(const MiddleCross from, CrossAt({a, b, faces[k]}, at));
      PM_ASSIGN_OR_RETURN(const MiddleCross to, CrossAt({c, d, faces[k]}, at));
      row_spans.push_back({from.first, to.first});
    }
    const auto guide = GuideThrough(middles, row_spans, {edit.start, edit.end});
    if (!guide.ok()) return Error(at + ".edges", std::string(guide.status().message()));
    for (std::size_t k = 0; k < spans; ++k) {
      const auto& [a, b] = edit.edges[k];
      const auto& [c, d] = edit.edges[(k + 1) % count];
      const GuideSection& section = (*guide)[k];
      controls_.Put({a, b, faces[k], section.from.d, section.from.dd});
      controls_.Put({c, d, faces[k], section.to.d, section.to.dd});
    }
    if (!edit.closed) {  // the faces beyond the ends of the row follow
      controls_.DropAcross({edit.edges[0][0], edit.edges[0][1], faces.front(), {}, {}});
      controls_.DropAcross({edit.edges.back()[0], edit.edges.back()[1], faces.back(), {}, {}});
    }
    return Changed();
  }

 private:
  static absl::Status Error(const std::string& field, const std::string& text) {
    return absl::InvalidArgumentError(field + " " + text);
  }
  absl::Status Changed() {
    joined_.reset();
    given_ = nullptr;
    return absl::OkStatus();
  }

  absl::Status CheckVertex(int vertex, const std::string& at) const {
    const int count = static_cast<int>(network_.vertices.size());
    if (vertex >= 0 && vertex < count) return absl::OkStatus();
    return Error(at + ".vertex", fmt::format("= {}; must be in [0, {}]", vertex, count - 1));
  }

  static const char* Reason(GoalKind kind) {
    switch (kind) {
      case GoalKind::kPoint:
      case GoalKind::kFullness:
        return "another goal of this edit moves the same place";
      case GoalKind::kEdge:
        return "goals of this edge contradict, or its tangent planes hold it back";
      case GoalKind::kFit:
        return "the vertices, normals and middles that may move do not suffice; split the face or widen the "
               "band";
    }
    return "";
  }

  void Report(const std::vector<ReachedGoal>& reached, const std::string& at) {
    for (const ReachedGoal& goal : reached) {
      reached_.push_back(goal);
      reached_.back().edit = edit_;
      if (!goal.missed || findings_.size() >= kMaxFindings) continue;
      const char* list = goal.kind == GoalKind::kFullness ? "fullness" : "points";
      const std::string field = goal.kind == GoalKind::kEdge ? fmt::format("{}[{}]", at, goal.goal)
                                                             : fmt::format("{}.{}[{}]", at, list, goal.goal);
      findings_.push_back(MakeWarning(
          "GOAL_NOT_REACHED",
          fmt::format("{} comes to ({:.6g}, {:.6g}, {:.6g}), {:.3g} from its target; {}", field,
                      goal.reached.x(), goal.reached.y(), goal.reached.z(), goal.distance, Reason(goal.kind)),
          {.point = goal.reached, .field = field}));
    }
  }

  // The largest distance between places of faces and the same places after the split, over a grid.
  double LargestChange(const std::vector<DividedFace>& divided, const JoinedNetwork& before) const {
    constexpr int kSteps = 12;
    double most = 0.0;
    for (std::size_t f = 0; f < before.model.patches.size(); ++f) {
      const bool cut = std::ranges::any_of(divided, [&](const DividedFace& d) { return At(d.face) == f; });
      const PatchShape &old = before.model.patches[f].shape, &now = joined_->model.patches[f].shape;
      if (cut || std::ranges::equal(ControlPoints(old), ControlPoints(now))) continue;
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= (IsTriangle(old) ? kSteps - i : kSteps); ++j) {
          const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
          most = std::max(most, (Position(now, u, v) - Position(old, u, v)).norm());
        }
      }
    }
    for (const DividedFace& face : divided) {
      const PatchShape& whole = before.model.patches[At(face.face)].shape;
      for (const bool low : {true, false}) {
        const PatchShape& half = joined_->model.patches[At(low ? face.face : face.made)].shape;
        const double from = low ? 0.0 : face.at, length = low ? face.at : 1.0 - face.at;
        for (int i = 0; i <= kSteps; ++i) {
          for (int j = 0; j <= kSteps; ++j) {
            const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
            const Vec3 old =
                face.along_u ? Position(whole, from + length * u, v) : Position(whole, u, from + length * v);
            most = std::max(most, (Position(half, u, v) - old).norm());
          }
        }
      }
    }
    return most;
  }

  // Lines with this edge become edges of their own, with the same curves.
  void FreeLinesOf(int start, int end) {
    Diagnostics findings;
    const CurveNetwork whole = WithLinesAsEdges(network_, findings);
    std::set<int> freed;
    for (const NetworkEdge& edge : whole.edges) {
      if (edge.line && SameEdge(edge.start, edge.end, start, end)) freed.insert(*edge.line);
    }
    for (NetworkEdge edge : whole.edges) {
      if (!edge.line || !freed.contains(*edge.line)) continue;
      edge.line.reset();
      network_.edges.push_back(std::move(edge));
    }
    std::vector<NetworkLine> kept;
    for (std::size_t k = 0; k < network_.lines.size(); ++k) {
      if (!freed.contains(static_cast<int>(k))) kept.push_back(network_.lines[k]);
    }
    network_.lines = std::move(kept);
  }

  // At both ends of an edge, two listed normals that serve one face each of the edge become their mean.
  void ShareNormals(const TableEdge& edge) {
    const int a = joined_->face_of[At(edge.faces[0].face)], b = joined_->face_of[At(edge.faces[1].face)];
    for (const int vertex : {edge.start, edge.end}) {
      auto& normals = network_.vertices[At(vertex)].normals;
      const auto serves = [](int face) {
        return [face](const NetworkVertex::Normal& n) { return std::ranges::count(n.faces, face) > 0; };
      };
      const auto first = std::ranges::find_if(normals, serves(a)),
                 second = std::ranges::find_if(normals, serves(b));
      if (first == normals.end() || second == normals.end() || first == second) continue;
      const Vec3 n = first->direction.normalized(), m = second->direction.normalized();
      const Vec3 mean = n.dot(m) < 0.0 ? Vec3(n - m) : Vec3(n + m);
      if (!(mean.norm() > 1e-9)) continue;
      first->direction = mean.normalized();
      first->faces.insert(first->faces.end(), second->faces.begin(), second->faces.end());
      std::ranges::sort(first->faces);
      normals.erase(second);
    }
  }

  absl::Status CheckFace(int face, const std::string& at) const {
    const int count = static_cast<int>(network_.faces.size());
    if (face >= 0 && face < count) return absl::OkStatus();
    return Error(at + ".face", fmt::format("= {}; must be in [0, {}]", face, count - 1));
  }

  // Returns the side of the face that is the edge.
  absl::StatusOr<int> CheckSide(const EdgeOfFace& e, const std::string& at) const {
    PM_RETURN_IF_ERROR(CheckFace(e.face, at));
    const auto& loop = network_.faces[At(e.face)].vertices;
    if (loop.size() != 4 || network_.faces[At(e.face)].scheme != PatchScheme::kG2Gregory) {
      return Error(at + ".face", fmt::format("= {}; must be a G2-Gregory face", e.face));
    }
    for (int s = 0; s < 4; ++s) {
      if (SameEdge(loop[At(s)], loop[At((s + 1) % 4)], e.start, e.end)) return s;
    }
    return Error(at,
                 fmt::format("names the edge {} {}, which is not beside face {}", e.start, e.end, e.face));
  }

  absl::Status Join(const std::string& at) {
    if (!joined_ && given_ != nullptr) joined_ = *given_;
    if (!joined_) {
      network_.controls = controls_.List();
      PM_ASSIGN_OR_RETURN(joined_, JoinNetwork(network_, run_));
    }
    if (!joined_->model.patches.empty()) return absl::OkStatus();
    return Error(
        at, "asks for the surface before it, which cannot be made: " + joined_->findings.front().message);
  }

  absl::StatusOr<MiddleCross> CrossAt(const EdgeOfFace& e, const std::string& at) {
    PM_ASSIGN_OR_RETURN(const int side, CheckSide(e, at));
    PM_RETURN_IF_ERROR(Join(at));
    return AcrossMiddle(joined_->model.patches[At(e.face)].shape, side);
  }

  // The faces that meet `face` smoothly at the vertex.
  absl::StatusOr<std::vector<int>> Group(int vertex, int face, const std::string& at) {
    PM_RETURN_IF_ERROR(Join(at));
    std::vector<int> group = {face};
    for (std::size_t k = 0; k < group.size(); ++k) {
      for (const JoinedEdge& edge : joined_->edges) {
        const TableEdge& here = edge.topology;
        if (here.start != vertex && here.end != vertex) continue;
        const bool follows = edge.kind == EdgeKind::kFollowing;
        if (edge.kind != EdgeKind::kSmooth && !follows) continue;
        const TableEdge& across = follows ? joined_->edges[At(here.part->whole)].topology : here;
        const int a = joined_->face_of[At(here.faces[0].face)],
                  b = joined_->face_of[At(across.faces.back().face)];
        if (a != group[k] && b != group[k]) continue;
        const int other = a == group[k] ? b : a;
        if (std::ranges::count(group, other) == 0) group.push_back(other);
      }
    }
    if (std::ranges::count(network_.faces[At(face)].vertices, vertex) == 0) {
      return Error(at + ".face", fmt::format("= {}; must touch vertex {}", face, vertex));
    }
    std::ranges::sort(group);
    return group;
  }

  // Returns the face beside `edge` whose opposite side is `next`.
  std::optional<int> FaceBetween(const TableEdge& edge, const std::array<int, 2>& next) const {
    for (const FaceSide& s : edge.faces) {
      if (At(s.face) >= network_.faces.size()) continue;  // a piece of a face with cuts
      const NetworkFace& face = network_.faces[At(s.face)];
      if (face.scheme != PatchScheme::kG2Gregory || face.vertices.size() != 4) continue;
      if (SameEdge(face.vertices[At((s.side + 2) % 4)], face.vertices[At((s.side + 3) % 4)], next[0],
                   next[1])) {
        return s.face;
      }
    }
    return std::nullopt;
  }

  CurveNetwork network_;
  const RunContext& run_;
  int edit_ = 0;
  std::vector<int> edge_of_;  // of the edges so far known; edits add others at the end
  std::vector<ReachedGoal> reached_;
  Diagnostics findings_;
  ControlStore controls_;                // with the edits; the controls in network_ are older
  std::optional<JoinedNetwork> joined_;  // with the edits; empty after a change
  const JoinedNetwork* given_;           // before all edits; null if unknown, and after a change
};

absl::StatusOr<EditedNetwork> Apply(CurveNetwork network, const JoinedNetwork* joined,
                                    const std::vector<NetworkEdit>& edits, const RunContext& run) {
  if (edits.size() > kMaxEdits) {
    return absl::InvalidArgumentError(
        fmt::format("edits are {}; must be at most {}", edits.size(), kMaxEdits));
  }
  Editor editor(std::move(network), joined, run);
  PM_RETURN_IF_ERROR(editor.ReadControls());
  for (std::size_t k = 0; k < edits.size(); ++k) {
    PM_RETURN_IF_ERROR(run.Check());
    const std::string at = fmt::format("edits[{}]", k);
    editor.Begin(static_cast<int>(k));
    PM_RETURN_IF_ERROR(std::visit([&](const auto& edit) { return editor.Apply(edit, at); }, edits[k]));
  }
  return editor.Take();
}

}  // namespace

absl::StatusOr<EditedNetwork> EditNetwork(CurveNetwork network, const std::vector<NetworkEdit>& edits,
                                          const RunContext& run) {
  return Apply(std::move(network), nullptr, edits, run);
}

absl::StatusOr<EditedNetwork> EditNetwork(CurveNetwork network, const JoinedNetwork& joined,
                                          const std::vector<NetworkEdit>& edits, const RunContext& run) {
  return Apply(std::move(network), &joined, edits, run);
}

}  // namespace patchmill
