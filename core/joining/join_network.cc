#include "core/joining/join_network.h"

#include <algorithm>
#include <optional>
#include <variant>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/joining/corner_normals.h"
#include "core/joining/cross_tangents.h"
#include "core/joining/curvature_rows.h"
#include "core/joining/edge_shapes.h"
#include "core/joining/face_cuts.h"
#include "core/joining/face_patch.h"
#include "core/joining/join_frame.h"
#include "core/joining/joint_checks.h"
#include "core/joining/line_edges.h"
#include "core/joining/network_findings.h"
#include "core/joining/t_places.h"

namespace patchmill {
namespace {

EdgeKind KindOf(const TableEdge& edge) {
  if (edge.divided || edge.part) {
    if (edge.crease) return EdgeKind::kCrease;
    return edge.divided ? EdgeKind::kLeading : EdgeKind::kFollowing;
  }
  if (edge.faces.size() < 2) return EdgeKind::kFree;
  return edge.crease ? EdgeKind::kCrease : EdgeKind::kSmooth;
}

// Makes all curves. A vertex on an edge gets its place as soon as the edge's curve is known.
std::vector<JoinedEdge> MakeEdges(JoinFrame& frame, const RunContext& run) {
  const EdgeTable& table = frame.table;
  std::vector<JoinedEdge> edges(table.edges.size());
  std::vector<int> waits(frame.network.vertices.size());  // 1: not placed yet
  std::vector<std::vector<std::size_t>> at(frame.network.vertices.size());
  for (const TVertex& t : table.t_vertices) waits[At(t.vertex)] = 1;
  std::vector<int> missing(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    edges[e].topology = table.edges[e];
    edges[e].kind = KindOf(table.edges[e]);
    for (const int v : {table.edges[e].start, table.edges[e].end}) {
      missing[e] += waits[At(v)];
      if (waits[At(v)] > 0) at[At(v)].push_back(e);
    }
  }
  std::vector<bool> made(edges.size());
  const auto make = [&](std::size_t e) {
    const auto& part = edges[e].topology.part;
    auto curve =
        !part || made[At(part->whole)] ? MakeEdgeCurve(frame, edges, edges[e].topology) : std::nullopt;
    made[e] = curve.has_value();
    edges[e].curve = curve ? *std::move(curve) : StraightEdge(frame, edges[e].topology);
  };
  for (std::size_t e = 0; e < edges.size() && !run.Cancelled(); ++e) {
    if (missing[e] == 0) make(e);
  }
  for (const TVertex& t : table.t_vertices) {
    if (run.Cancelled()) break;
    if (made[At(t.edge)]) PlaceTVertex(edges, t, frame);
    for (const std::size_t e : at[At(t.vertex)]) {
      if (--missing[e] == 0) make(e);
    }
  }
  for (std::size_t e = 0; e < edges.size() && !run.Cancelled(); ++e) {
    if (!made[e]) continue;
    CheckPlanes(frame, edges, edges[e]);
    CheckLoop(frame, edges[e]);
  }
  return edges;
}

PatchModel MakePatches(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const RunContext& run) {
  PatchModel model;
  model.join_tolerance = frame.network.join_tolerance;
  for (int f = 0; f < static_cast<int>(frame.network.faces.size()) && !run.Cancelled(); ++f) {
    const NetworkFace& face = frame.network.faces[At(f)];
    FaceBoundary boundary;
    boundary.sides = SideCount(face);
    for (int s = 0; s < boundary.sides; ++s) {
      const JoinedEdge& edge = edges[At(frame.table.face_edges[At(f)][At(s)])];
      std::size_t k = 0;
      while (edge.topology.faces[k].face != f || edge.topology.faces[k].side != s) ++k;
      const bool forward = frame.table.Forward({f, s}, frame.network);
      boundary.curve[At(s)] = forward ? edge.curve : Reversed(edge.curve);
      boundary.tangent[At(s)] = forward ? edge.tangents[k] : Reversed(edge.tangents[k]);
      if (face.scheme == PatchScheme::kHosaka) {
        boundary.breaks[At(s)] = HosakaBreaks(edge, edges);
        if (!forward) {
          std::ranges::reverse(boundary.breaks[At(s)]);
          for (double& at : boundary.breaks[At(s)]) at = 1.0 - at;
        }
      }
      if (face.scheme == PatchScheme::kG2Gregory) {
        boundary.rows[At(s)] = forward ? edge.rows[k] : Reversed(edge.rows[k]);
      }
    }
    model.patches.push_back({face.id, MakeFacePatch(boundary, face.scheme)});
    std::visit(
        [&face](auto& shape) {
          if constexpr (requires { shape.bulges; }) shape.bulges = face.bulges;
        },
        model.patches.back().shape);
  }
  return model;
}

// Runs the steps in order. A step with an error is the last one.
void Join(CurveNetwork network, const EdgeTable& table, const RunContext& run, JoinedNetwork& joined) {
  EstimateTPlaces(table, network);
  const NetworkWriter findings(network, joined.findings);
  JoinFrame frame{network, table, CornerNormals(network, table), findings};
  const auto go_on = [&] { return !HasError(joined.findings) && !run.Cancelled(); };
  joined.edges = MakeEdges(frame, run);
  if (go_on()) CheckCorners(frame, joined.edges);
  if (go_on()) CheckSchemes(frame, joined.edges);
  if (go_on()) AddCrossTangents(frame, joined.edges, run);
  if (go_on()) AddCurvatureRows(frame.network, table, findings, joined.edges);
  if (!go_on()) return;
  joined.model = MakePatches(frame, joined.edges, run);
  for (int f = 0; f < static_cast<int>(frame.network.faces.size()); ++f) {
    joined.face_of.push_back(frame.network.faces[At(f)].of.value_or(f));
  }
}

}  // namespace

absl::StatusOr<JoinedNetwork> JoinNetwork(const CurveNetwork& given, const RunContext& run) {
  JoinedNetwork joined;
  CurveNetwork network = WithCutFaces(WithLinesAsEdges(given, joined.findings), joined.findings);
  const EdgeTable table = BuildEdgeTable(network, joined.findings);
  if (!HasError(joined.findings)) Join(std::move(network), table, run, joined);
  PM_RETURN_IF_ERROR(run.Check());
  if (HasError(joined.findings)) joined.edges.clear(), joined.face_of.clear(), joined.model = {};
  return joined;
}

JoinedNetwork JoinNetwork(const CurveNetwork& network) { return *JoinNetwork(network, RunContext(1)); }

}  // namespace patchmill
