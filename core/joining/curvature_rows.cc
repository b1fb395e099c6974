#include "core/joining/curvature_rows.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/joining/fair_middles.h"

namespace patchmill {
namespace {

class RowMaker {
 public:
  RowMaker(const CurveNetwork& network, const EdgeTable& table, const NetworkWriter& findings,
           std::vector<JoinedEdge>& edges)
      : network_(network), table_(table), findings_(findings), edges_(edges) {}

  // Finds the edge and the face of each control and checks its vectors.
  void ReadControls() {
    for (int k = 0; k < static_cast<int>(network_.controls.size()); ++k) {
      const CrossControl& control = network_.controls[At(k)];
      const auto error = [&](std::string_view code, std::string_view text) {
        findings_.Error(code, findings_.AtControl(k), text);
      };
      const std::optional<int> edge = EdgeOf(control);
      if (!edge) {
        error("INVALID_CONTROL",
              fmt::format("is for face {} beside the edge of vertices {} and {}; there is none", control.face,
                          control.start, control.end));
        continue;
      }
      if (network_.faces[At(control.face)].scheme != PatchScheme::kG2Gregory) {
        error("INVALID_CONTROL", fmt::format("is for faces[{}], which is no G2-Gregory patch", control.face));
        continue;
      }
      const auto [it, fresh] = controls_.emplace(std::pair(*edge, control.face), k);
      if (!fresh)
        error("INVALID_CONTROL", fmt::format("is for the same edge and face as controls[{}]", it->second));
      const auto finite = [](const std::optional<Vec3>& v) { return !v || v->allFinite(); };
      if (!finite(control.first) || !finite(control.second)) {
        error("NOT_FINITE", "has a number that is not finite");
        continue;
      }
      const Vec3 along = Evaluate(edges_[At(*edge)].curve, kControlPlace).d;
      if (const auto& first = control.first;
          first && !(first->cross(along).norm() > kMinTangentSine * first->norm() * along.norm())) {
        error("INVALID_CONTROL", "has a first derivative without direction across the edge");
      }
    }
  }

  void Estimate() { fair_ = EstimateMiddles({network_, table_, edges_}); }

  void Fill(JoinedEdge& edge) {
    const auto& sides = edge.topology.faces;
    const bool any = std::ranges::any_of(sides, [&](const FaceSide& s) { return Wanted(s); });
    if (!any) return;
    edge.rows.resize(sides.size());
    if (edge.kind == EdgeKind::kLeading || edge.kind == EdgeKind::kFollowing) {
      TangentPlaneOnly(edge, "one face has a part of it only");
      edge.rows[0] = RowsWithTangent(SpanOf(edge.tangents[0], 0), SideOf(edge, sides[0], false));
      return;
    }
    if (edge.kind != EdgeKind::kSmooth) {
      for (std::size_t k = 0; k < sides.size(); ++k) {
        if (!Wanted(sides[k])) continue;
        auto rows = RowsAlone(SideOf(edge, sides[k], true));
        if (Folds(rows)) rows = RowsAlone(SideOf(edge, sides[k], false));
        if (const auto* fault = std::get_if<CurvatureFault>(&rows)) {
          Refuse(edge, *fault);
          edge.rows[k] = RowsWithTangent(SpanOf(edge.tangents[k], 0), SideOf(edge, sides[k], false));
        } else {
          edge.rows[k] = std::get<CrossRows>(rows);
        }
      }
      return;
    }
    if (Wanted(sides[0]) && Wanted(sides[1])) {
      auto joint = JoinCurvature(SideOf(edge, sides[0], true), SideOf(edge, sides[1], true));
      if (Folds(joint)) joint = JoinCurvature(SideOf(edge, sides[0], false), SideOf(edge, sides[1], false));
      if (const auto* both = std::get_if<std::array<CrossRows, 2>>(&joint)) {
        edge.rows.assign(both->begin(), both->end());
        edge.equal_curvature = true;
        return;
      }
      Refuse(edge, std::get<CurvatureFault>(joint));
    } else {
      const FaceSide& other = Wanted(sides[0]) ? sides[1] : sides[0];
      TangentPlaneOnly(edge, fmt::format("faces[{}] is no G2-Gregory patch", other.face));
    }
    for (std::size_t k = 0; k < sides.size(); ++k) {
      if (Wanted(sides[k]))
        edge.rows[k] = RowsWithTangent(SpanOf(edge.tangents[k], 0), SideOf(edge, sides[k], false));
    }
  }

 private:
  bool Wanted(const FaceSide& s) const {
    return network_.faces[At(s.face)].scheme == PatchScheme::kG2Gregory;
  }

  int IndexOf(const JoinedEdge& edge) const { return static_cast<int>(&edge - edges_.data()); }
  std::optional<int> EdgeOf(const CrossControl& control) const {
    if (control.face < 0 || control.face >= static_cast<int>(network_.faces.size())) return std::nullopt;
    for (int s = 0; s < SideCount(network_.faces[At(control.face)]); ++s) {
      const int edge = table_.face_edges[At(control.face)][At(s)];
      const TableEdge& ends = table_.edges[At(edge)];
      if (std::minmax(ends.start, ends.end) == std::minmax(control.start, control.end)) return edge;
    }
    return std::nullopt;
  }

  Where Place(const JoinedEdge& edge) const {
    return edge.topology.given ? findings_.AtEdge(*edge.topology.given)
                               : findings_.AtVertex(edge.topology.start);
  }

  // Derivatives of the face's other edge at the start (end) of this edge, in the direction in which it
  // leaves.
  CrossEnd CrossingAt(const FaceSide& s, bool start) const {
    const int n = SideCount(network_.faces[At(s.face)]);
    const bool first = table_.Forward(s, network_) == start;  // at the side's own first corner
    const FaceSide other{s.face, first ? (s.side + n - 1) % n : (s.side + 1) % n};
    const BezierChain& curve = edges_[At(table_.face_edges[At(other.face)][At(other.side)])].curve;
    const CurveJet jet = Evaluate(curve, table_.Forward(other, network_) == first ? 1.0 : 0.0);
    return {table_.Forward(other, network_) == first ? Vec3(-jet.d) : jet.d, jet.dd};
  }

  // Where the estimated middle would fold a patch, the mean of the ends may still serve.
  template <class Rows>
  static bool Folds(const std::variant<Rows, CurvatureFault>& rows) {
    const auto* fault = std::get_if<CurvatureFault>(&rows);
    return fault != nullptr && fault->kind == CurvatureFault::Kind::kTurn;
  }

  CrossSide SideOf(const JoinedEdge& edge, const FaceSide& s, bool fair) const {
    CrossSide side{CrossingAt(s, true), CrossingAt(s, false), {}, {}, {}};
    const FaceSide& first = edge.topology.faces[0];
    if (fair) side.fair = fair_[At(IndexOf(edge))][s.face == first.face && s.side == first.side ? 0 : 1];
    if (const auto control = controls_.find({IndexOf(edge), s.face}); control != controls_.end()) {
      side.first = network_.controls[At(control->second)].first;
      side.second = network_.controls[At(control->second)].second;
    }
    return side;
  }

  void TangentPlaneOnly(const JoinedEdge& edge, std::string_view why) const {
    const auto control = controls_.lower_bound({IndexOf(edge), 0});
    if (control != controls_.end() && control->first.first == IndexOf(edge)) {
      findings_.Error("INVALID_CONTROL", findings_.AtControl(control->second),
                      fmt::format("cannot be met: {}", why));
      return;
    }
    findings_.Warning("TANGENT_PLANE_ONLY", Place(edge),
                      fmt::format("from vertex {} to {} gets equal tangent planes, not equal curvature: {}",
                                  edge.topology.start, edge.topology.end, why));
  }

  void Refuse(const JoinedEdge& edge, const CurvatureFault& fault) const {
    const int vertex = fault.at_end ? edge.topology.end : edge.topology.start;
    switch (fault.kind) {
      case CurvatureFault::Kind::kDirection:
        return TangentPlaneOnly(
            edge, fmt::format("at vertex {} the edges that cross it are {:.3g} rad out of line", vertex,
                              fault.amount));
      case CurvatureFault::Kind::kCurvature:
        return TangentPlaneOnly(
            edge, fmt::format("at vertex {} the edges that cross it differ in curvature by {:.3g} of it",
                              vertex, fault.amount));
      case CurvatureFault::Kind::kTurn:
        return TangentPlaneOnly(edge, "the directions across it turn back along it");
      case CurvatureFault::Kind::kControlsDiffer:
        return TangentPlaneOnly(edge, fmt::format("those of its two faces differ by {:.3g}", fault.amount));
    }
  }

  const CurveNetwork& network_;
  const EdgeTable& table_;
  const NetworkWriter& findings_;
  std::vector<JoinedEdge>& edges_;
  FairMiddles fair_;
  std::map<std::pair<int, int>, int> controls_;  // key: edge and face
};

}  // namespace

void AddCurvatureRows(const CurveNetwork& network, const EdgeTable& table, const NetworkWriter& findings,
                      std::vector<JoinedEdge>& edges) {
  RowMaker maker(network, table, findings, edges);
  maker.ReadControls();
  if (findings.ErrorWritten()) return;
  maker.Estimate();
  for (JoinedEdge& edge : edges) maker.Fill(edge);
}

}  // namespace patchmill
