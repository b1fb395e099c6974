#include "core/joining/fair_joints.h"

#include <algorithm>
#include <type_traits>

#include "core/base/index.h"
#include "core/joining/curvature_joint.h"

namespace patchmill {
namespace {

CrossEnd CrossOf(const FaceFrame& frame) { return {FirstAtStart(frame.ac), SecondAtStart(frame.ac)}; }

// The side between a and c, and its edge.
FaceSide SideAcross(const FaceFrame& frame) {
  return {frame.face, frame.c == (frame.a + 3) % 4 ? frame.c : frame.a};
}
int EdgeAcross(const CurvedNetwork& curved, const FaceFrame& frame) {
  const FaceSide side = SideAcross(frame);
  return curved.table.face_edges[At(side.face)][At(side.side)];
}

class Finder {
 public:
  explicit Finder(const CurvedNetwork& curved) : curved_(curved) {}

  FairJoints Find() {
    const int edges = static_cast<int>(curved_.edges.size());
    joints_.ends.resize(At(edges));
    for (int e = 0; e < edges; ++e) joints_.ends[At(e)] = EndsOf(curved_.edges[At(e)]);
    LeaveOutFaces();
    for (int e = 0; e < edges; ++e) {
      if (!joints_.ends[At(e)]) continue;
      for (const int end : {0, 1}) SetSlopes(e, end);
    }
    return std::move(joints_);
  }

 private:
  std::optional<std::array<JointEnd, 2>> EndsOf(const JoinedEdge& edge) const {
    const auto& sides = edge.topology.faces;
    const auto g2 = [&](const FaceSide& s) {
      return curved_.network.faces[At(s.face)].scheme == PatchScheme::kG2Gregory;
    };
    if (edge.kind != EdgeKind::kSmooth || sides.size() != 2 || !std::ranges::all_of(sides, g2)) {
      return std::nullopt;
    }
    std::array<JointEnd, 2> ends;
    for (const int end : {0, 1}) {
      const auto frames = FramesAt(curved_, edge.topology, end);
      const auto &p = frames[0].ac, &q = frames[1].ac;
      if (CrossingFault(CrossOf(frames[0]), CrossOf(frames[1]), end == 1)) return std::nullopt;
      const double k = FirstAtStart(q).norm() / FirstAtStart(p).norm();
      ends[At(end)].ratio = k;
      ends[At(end)].second = SecondAtStart(q) - k * k * SecondAtStart(p);
      ends[At(end)].third = ThirdAtStart(q) + k * k * k * ThirdAtStart(p);
    }
    return ends;
  }

  // A smooth side that is no joint leaves its face out, and all joints of this face with it.
  void LeaveOutFaces() {
    std::vector<bool> out(curved_.network.faces.size()), joined(out.size());
    for (std::size_t e = 0; e < curved_.edges.size(); ++e) {
      const JoinedEdge& edge = curved_.edges[e];
      if (joints_.ends[e] || edge.kind == EdgeKind::kFree || edge.kind == EdgeKind::kCrease) continue;
      for (const FaceSide& s : edge.topology.faces) out[At(s.face)] = true;
    }
    for (std::size_t e = 0; e < curved_.edges.size(); ++e) {
      if (!joints_.ends[e]) continue;
      const auto& sides = curved_.edges[e].topology.faces;
      if (std::ranges::any_of(sides, [&](const FaceSide& s) { return out[At(s.face)]; })) {
        joints_.ends[e].reset();
        continue;
      }
      for (const FaceSide& s : sides) joined[At(s.face)] = true;
    }
    joints_.faces = std::move(joined);
  }

  struct Beyond {
    double step = 0.0;  // length of the next joint, in the parameter of this one
    JointEnd far;       // its far end, with the first face on the side of the first face here
  };

  // The joint by which the line of edges goes on beyond one end of a joint.
  std::optional<Beyond> Continued(int edge, int end) const {
    const CurveNetwork& network = curved_.network;
    const EdgeTable& table = curved_.table;
    const auto here = FramesAt(curved_, table.edges[At(edge)], end);
    const int crossing = EdgeAcross(curved_, here[0]);
    if (!joints_.ends[At(crossing)]) return std::nullopt;
    const auto& sides = table.edges[At(crossing)].faces;
    const FaceSide own = SideAcross(here[0]);
    const bool first = sides[0].face == own.face && sides[0].side == own.side;
    const FaceSide across = sides[first ? 1 : 0];
    const int vertex = network.faces[At(here[0].face)].vertices[At(here[0].a)];
    const bool leaves = network.faces[At(across.face)].vertices[At(across.side)] == vertex;
    const int next = table.face_edges[At(across.face)][At((across.side + (leaves ? 3 : 1)) % 4)];
    if (!joints_.ends[At(next)] || next == edge) return std::nullopt;
    const int near = table.edges[At(next)].start == vertex ? 0 : 1;
    const auto there = FramesAt(curved_, table.edges[At(next)], near);
    const bool same = there[0].face == across.face && EdgeAcross(curved_, there[0]) == crossing;
    // The line goes on along this edge only if it does so beside the second face too.
    if (EdgeAcross(curved_, there[same ? 1 : 0]) != EdgeAcross(curved_, here[1])) return std::nullopt;
    Beyond beyond{FirstAtStart(there[0].ab).norm() / FirstAtStart(here[0].ab).norm(),
                  (*joints_.ends[At(next)])[At(1 - near)]};
    if (!same) {
      const double k = beyond.far.ratio;
      beyond.far.ratio = 1.0 / k;
      beyond.far.second = -beyond.far.second / (k * k);
      beyond.far.third = beyond.far.third / (k * k * k);
    }
    return beyond;
  }

  void SetSlopes(int edge, int end) {
    JointEnd& here = (*joints_.ends[At(edge)])[At(end)];
    const JointEnd& next = (*joints_.ends[At(edge)])[At(1 - end)];
    const auto before = Continued(edge, end), after = before ? std::nullopt : Continued(edge, 1 - end);
    const auto slope = [&](const auto& of) {
      using Value = std::decay_t<decltype(of(here))>;
      const Value first = of(next) - of(here);
      if (before) {
        const double s = before->step;
        return Value((s * first + (of(here) - of(before->far)) / s) / (1.0 + s));
      }
      if (!after) return first;
      const double s = after->step;
      return Value(first + (first - (of(after->far) - of(next)) / s) / (1.0 + s));
    };
    here.ratio_slope = slope([](const JointEnd& j) { return j.ratio; });
    here.second_slope = slope([](const JointEnd& j) { return j.second; });
    here.third_slope = slope([](const JointEnd& j) { return j.third; });
  }

  const CurvedNetwork& curved_;
  FairJoints joints_;
};

}  // namespace

FairJoints FindFairJoints(const CurvedNetwork& curved) { return Finder(curved).Find(); }

}  // namespace patchmill
