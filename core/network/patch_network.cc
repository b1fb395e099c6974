#include "core/network/patch_network.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <absl/strings/str_cat.h>
#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/network/corner_vertices.h"
#include "core/network/edge_angles.h"
#include "core/network/edge_links.h"
#include "core/network/face_edges.h"
#include "core/network/findings.h"
#include "core/network/half_edges.h"
#include "core/network/open_edges.h"
#include "core/network/part_links.h"

namespace patchmill {
namespace {

// An edge is negligible if it is shorter than both this share of its patch's longest edge and this share of
// the diagonal of the model.
constexpr double kNearlyCollapsedOfPatch = 1e-2;
constexpr double kNearlyCollapsedOfModel = 1e-3;
constexpr double kGapOfModel =
    1e-3;  // edges farther apart than this share of the diagonal are not meant to meet

absl::Status FaultsAsStatus(const Diagnostics& faults) {
  const std::string more =
      faults.size() > 1 ? absl::StrCat(" (and ", faults.size() - 1, " more faults)") : "";
  return absl::InvalidArgumentError(absl::StrCat(faults.front().message, more));
}

std::vector<bool> NearlyCollapsed(const EdgeCurves& curves, const std::vector<EdgeLink>& links,
                                  double diagonal) {
  std::vector<bool> nearly(links.size());
  for (int e = 0; e < curves.count();) {
    double longest = 0.0;
    int end = e;
    for (; end < curves.count() && curves.edge(end).patch == curves.edge(e).patch; ++end) {
      longest = std::max(longest, curves.length(end));
    }
    const double limit = std::min(kNearlyCollapsedOfPatch * longest, kNearlyCollapsedOfModel * diagonal);
    for (; e < end; ++e) nearly[At(e)] = !links[At(e)].collapsed && curves.length(e) < limit;
  }
  return nearly;
}

void Join(const EdgeCurves& curves, const EdgeGap& match, std::vector<EdgeLink>& links) {
  for (const auto& [from, to] : {std::pair(match.edge, match.other), std::pair(match.other, match.edge)}) {
    links[At(from)].neighbor = curves.edge(to);
    links[At(from)].reversed = match.reversed;
    links[At(from)].gap = match.distance;
  }
}

// Nearly collapsed edges are not reported as open, but lines cross them, and they cover the last bit of a
// longer edge. So they count where anything lies along another edge.
struct LinkedEdges {
  const EdgeCurves& curves;
  const std::vector<EdgeEnds>& ends;
  const std::vector<bool>& nearly_collapsed;
  const std::vector<EdgeLink>& links;
};
std::optional<OpenEdgeReport> InspectWithNearlyCollapsed(const LinkedEdges& edges, double tolerance,
                                                         const RunContext& run) {
  std::vector<int> open;
  bool more = false, any = false;
  for (int e = 0; e < edges.curves.count(); ++e) {
    const EdgeLink& link = edges.links[At(e)];
    if (link.neighbor || link.collapsed) continue;
    open.push_back(e);
    (edges.nearly_collapsed[At(e)] ? more : any) = true;
  }
  if (!more || !any) return std::nullopt;
  return InspectOpenEdges(edges.curves, edges.ends, open, {tolerance, 0.0}, run);
}

// All results of BuildNetwork from which its findings are made.
struct Facts {
  const EdgeCurves& curves;
  const std::vector<EdgeEnds>& ends;
  const CornerVertices& corners;
  const EdgeClusters& clusters;
  const std::vector<std::optional<PatchId>>& duplicate_of;
  const std::vector<bool>& nearly_collapsed;
  const OpenEdgeReport& open;
  const Topology& topology;
  const PatchModel& model;

  std::optional<FaceId> FaceOf(PatchId patch) const { return model.patches[patch.index()].face; }
  std::optional<FaceId> FaceOf(int edge) const { return FaceOf(curves.edge(edge).patch); }
};

void ReportEdges(const Facts& facts, PatchNetwork& network, NetworkFindings& findings) {
  for (int e = 0; e < facts.curves.count(); ++e) {
    const EdgeLink& link = network.edges[At(e)];
    if (IsOfFaces(network.model, link)) continue;
    if (link.collapsed) {
      findings.AtEdge("COLLAPSED_EDGE", Severity::kInfo, e, [&] { return findings.Name(e) + " is a point"; });
    } else if (facts.nearly_collapsed[At(e)]) {
      findings.AtEdge("NEARLY_COLLAPSED_EDGE", Severity::kWarning, e, [&] {
        return fmt::format("{} is only {:.3g} mm long{}", findings.Name(e), facts.curves.length(e),
                           link.neighbor ? "" : " and has no neighbour");
      });
    } else if (!link.neighbor && !link.on_t_junction) {
      ++network.open_edge_count;
      findings.AtEdge("OPEN_EDGE", Severity::kInfo, e, [&] {
        return fmt::format("{} has no neighbour ({:.4g} mm long)", findings.Name(e), facts.curves.length(e));
      });
    }
    if (!link.neighbor || link.max_angle <= kTangentBreak) continue;
    if (facts.duplicate_of[link.self.patch.index()]) continue;  // its original has reported it
    const int other = network.first_edge[link.neighbor->patch.index()] + link.neighbor->edge;
    const auto& back = network.edges[At(other)].neighbor;
    if (back && *back == link.self && other < e) continue;  // the other side has reported it
    findings.AtEdge("TANGENT_BREAK", Severity::kInfo, e, [&] {
      return fmt::format("{} meets {} at an angle of up to {:.4g} degrees", findings.Name(e),
                         findings.Name(other), Degrees(link.max_angle));
    });
  }
}

// Nobody who speaks of faces knows the edges of their patches: one finding for each face and for each two.
void ReportFaceEdges(const Facts& facts, PatchNetwork& network, NetworkFindings& findings) {
  std::vector<bool> left_out = facts.nearly_collapsed;
  for (int e = 0; e < facts.curves.count(); ++e) {  // the original of a duplicate stands for both
    if (facts.duplicate_of[facts.curves.edge(e).patch.index()]) left_out[At(e)] = true;
  }
  const FaceEdges edges =
      EdgesOfFaces(network.model, facts.curves, {network.edges, network.part_links}, left_out);
  const auto title = [&](FaceId face) { return Title(network.model.faces[face.index()]); };
  for (const OpenFaceEdges& open : edges.open) {
    network.open_edge_count += open.count;
    findings.AtEdge("OPEN_EDGE", Severity::kInfo, open.longest, [&] {
      return fmt::format("face {} has no neighbour along {} edge{}, {:.4g} mm in all", title(open.face),
                         open.count, open.count > 1 ? "s" : "", open.length);
    });
  }
  for (const FaceCrease& crease : edges.creases) {
    network.convex_length += crease.convex_length;
    network.concave_length += crease.concave_length;
    findings.AtEdge("TANGENT_BREAK", Severity::kInfo, crease.sharpest, [&] {
      return fmt::format("face {} meets face {} at an angle of up to {:.4g} degrees, along {:.4g} mm{}",
                         title(crease.face), title(crease.other), Degrees(crease.max_angle), crease.length,
                         crease.concave_length > 0.0
                             ? fmt::format(", of which {:.4g} mm are an inner corner", crease.concave_length)
                             : std::string());
    });
  }
}

void ReportMeetings(const Facts& facts, PatchNetwork& network, NetworkFindings& findings) {
  for (const TJunction& t : facts.open.t_junctions) {
    const auto of_face = [&](int e) { return IsOfFaces(network.model, network.edges[At(e)]); };
    if (of_face(t.long_edge) && std::ranges::all_of(t.short_edges, of_face)) continue;
    ++network.t_junction_count;
    findings.AtEdge("T_JUNCTION", Severity::kInfo, t.long_edge, [&] {
      const bool alone = t.short_edges.empty();
      return alone ? fmt::format("{} runs along parts of other edges", findings.Name(t.long_edge))
                   : fmt::format("{} meets {} shorter edge{}, first {}", findings.Name(t.long_edge),
                                 t.short_edges.size(), t.short_edges.size() > 1 ? "s" : "",
                                 findings.Name(t.short_edges.front()));
    });
  }
  for (const EdgeGap& gap : facts.open.gaps) {
    if (gap.distance <= network.join_tolerance) continue;
    if (const auto face = facts.FaceOf(gap.edge); face && face == facts.FaceOf(gap.other)) continue;
    findings.AtEdge("GAP", Severity::kWarning, gap.edge, [&] {
      return fmt::format("{} and {} are up to {:.4g} mm apart; the join tolerance is {:.4g} mm",
                         findings.Name(gap.edge), findings.Name(gap.other), gap.distance,
                         network.join_tolerance);
    });
  }
  struct Fold {
    int edge = 0;   // one of them
    int count = 0;  // edges inside the face that more than two of its patches share
  };
  std::map<FaceId, Fold> folds;
  for (const std::vector<int>& members : facts.clusters.members) {
    if (members.size() < 3) continue;
    const std::optional<FaceId> face = facts.FaceOf(members[0]);
    if (face && std::ranges::all_of(members, [&](int e) { return facts.FaceOf(e) == face; })) {
      ++folds.try_emplace(*face, Fold{members[2], 0}).first->second.count;
      continue;
    }
    findings.AtEdge("NON_MANIFOLD_EDGE", Severity::kWarning, members[2], [&] {
      return fmt::format("{} is shared by {} edges, first {}", findings.Name(members[2]), members.size(),
                         findings.Name(members[0]));
    });
  }
  for (const auto& entry : folds) {
    const auto& face = entry.first;
    const auto& fold = entry.second;
    findings.AtEdge("NON_MANIFOLD_EDGE", Severity::kWarning, fold.edge, [&] {
      const bool one = fold.count == 1;
      return fmt::format(
          "face {} is folded, or has needles narrower than the join tolerance: {} edge{} inside it {} shared "
          "by more than two of its patches",
          Title(network.model.faces[face.index()]), fold.count, one ? "" : "s", one ? "is" : "are");
    });
  }
  if (facts.open.limited) {
    findings.AtPoint("SEARCH_LIMITED", Severity::kWarning, facts.corners.position.front(),
                     "too many open edges lie together; gaps and T-junctions were not all looked for");
  }
}

// Fans that a T-junction or a gap keeps apart get no finding of their own.
void ReportVertices(const Facts& facts, const PatchNetwork& network, NetworkFindings& findings) {
  std::vector<bool> excused(facts.corners.position.size());
  for (int e = 0; e < facts.curves.count(); ++e) {
    const EdgeLink& link = network.edges[At(e)];
    const bool many = facts.clusters.cluster_of[At(e)] >= 0 &&
                      facts.clusters.members[At(facts.clusters.cluster_of[At(e)])].size() > 2;
    if (!many && !link.on_t_junction && (link.neighbor || link.gap == 0.0)) continue;
    excused[At(facts.ends[At(e)].start)] = excused[At(facts.ends[At(e)].end)] = true;
  }
  for (const TJunction& t : facts.open.t_junctions) {
    excused[At(facts.ends[At(t.long_edge)].start)] = excused[At(facts.ends[At(t.long_edge)].end)] = true;
  }
  for (const int v : facts.topology.split_vertices) {
    if (excused[At(v)]) continue;
    findings.AtPoint("NON_MANIFOLD_VERTEX", Severity::kInfo, facts.corners.position[At(v)],
                     "patches touch in this corner without sharing an edge");
  }
}

void ReportPatches(const Facts& facts, NetworkFindings& findings) {
  std::set<FaceId> doubled, turned;  // one finding for each face
  for (std::size_t k = 0; k < facts.duplicate_of.size(); ++k) {
    if (!facts.duplicate_of[k]) continue;
    const std::optional<FaceId> face = facts.FaceOf(PatchId(k));
    if (face && face == facts.FaceOf(*facts.duplicate_of[k])) {
      if (!doubled.insert(*face).second) continue;
      findings.AtPatch("DUPLICATE_PATCH", Severity::kWarning, PatchId(k), [&] {
        return fmt::format("a part of {} lies twice in the same place", findings.Name(PatchId(k)));
      });
      continue;
    }
    findings.AtPatch("DUPLICATE_PATCH", Severity::kWarning, PatchId(k), [&] {
      return fmt::format("{} is the same surface as {}", findings.Name(PatchId(k)),
                         findings.Name(*facts.duplicate_of[k]));
    });
  }
  for (const Component& c : facts.topology.components) {
    if (c.one_sided) {
      findings.AtPatch("INCONSISTENT_ORIENTATION", Severity::kInfo, c.first, [&] {
        return fmt::format("the {} patches joined to {} form a one-sided surface (Moebius strip)", c.patches,
                           findings.Name(c.first));
      });
    } else if (c.odd) {
      const std::optional<FaceId> face = facts.FaceOf(*c.odd);
      if (face && face == facts.FaceOf(c.first) && !turned.insert(*face).second) continue;
      findings.AtPatch("INCONSISTENT_ORIENTATION", Severity::kInfo, *c.odd, [&] {
        return fmt::format("{} of the {} patches joined to {} look to the other side, first {}", c.turned,
                           c.patches, findings.Name(c.first), findings.Name(*c.odd));
      });
    }
  }
}

}  // namespace

const EdgeLink& PatchNetwork::Link(PatchEdge edge) const {
  return edges[At(first_edge[edge.patch.index()] + edge.edge)];
}

absl::StatusOr<PatchNetwork> BuildNetwork(PatchModel model, const RunContext& run) {
  const auto done = [&run](double fraction) {
    run.Progress("joins", fraction);
    return run.Check();
  };
  PM_RETURN_IF_ERROR(done(0.0));
  const Diagnostics faults = ValidateModel(model);
  if (!faults.empty()) return FaultsAsStatus(faults);
  PatchNetwork network;
  network.model = std::move(model);
  const double diagonal = ControlBox(network.model).Diagonal();
  const double tolerance = network.model.join_tolerance.value_or(kDefaultJoinTolerance * diagonal);
  network.join_tolerance = tolerance;

  PM_RETURN_IF_ERROR(done(0.1));
  const EdgeCurves curves(network.model, run);
  PM_RETURN_IF_ERROR(done(0.3));
  network.first_edge = curves.first_edge();
  std::vector<Vec3> edge_ends;
  for (int e = 0; e < curves.count(); ++e) {
    edge_ends.push_back(curves.start(e));
    edge_ends.push_back(curves.end(e));
  }
  const CornerVertices corners = MergeCorners(edge_ends, tolerance);
  PM_RETURN_IF_ERROR(done(0.4));
  const std::vector<EdgeEnds> ends = EdgeEndVertices(curves, corners);
  const EdgeClusters clusters = ClusterEdges(curves, ends, tolerance, run);
  PM_RETURN_IF_ERROR(done(0.5));
  const auto duplicate_of = FindDuplicates(network.model, curves, clusters, tolerance);
  network.edges = LinkEdges(curves, clusters, duplicate_of, tolerance, run);
  PM_RETURN_IF_ERROR(done(0.6));

  const std::vector<bool> nearly = NearlyCollapsed(curves, network.edges, diagonal);
  std::vector<int> open;
  for (int e = 0; e < curves.count(); ++e) {
    const EdgeLink& link = network.edges[At(e)];
    if (!link.neighbor && !link.collapsed && !nearly[At(e)]) open.push_back(e);
  }
  const double gap_limit = std::max(10.0 * tolerance, kGapOfModel * diagonal);
  const OpenEdgeReport meetings = InspectOpenEdges(curves, ends, open, {tolerance, gap_limit}, run);
  PM_RETURN_IF_ERROR(done(0.7));
  for (const int e : open) network.edges[At(e)].on_t_junction = meetings.covered[At(e)];
  for (const EdgeGap& gap : meetings.gaps) {
    if (gap.distance <= tolerance) {
      Join(curves, gap, network.edges);
    } else {
      network.edges[At(gap.edge)].gap = network.edges[At(gap.other)].gap = gap.distance;
    }
  }
  const auto all = InspectWithNearlyCollapsed({curves, ends, nearly, network.edges}, tolerance, run);
  if (all) {
    for (const int e : open) network.edges[At(e)].on_t_junction |= all->covered[At(e)];
  }
  if (std::ranges::any_of(network.edges, &EdgeLink::on_t_junction)) {
    network.part_links = FindPartLinks(curves, network.edges, (all ? *all : meetings).t_junctions, run);
  }
  PM_RETURN_IF_ERROR(done(0.75));
  MeasureAngles(curves, run, network.edges);
  PM_RETURN_IF_ERROR(done(0.8));
  for (EdgeLink& link : network.edges) {  // a copy does not fold back onto its original
    const auto& original = duplicate_of[link.self.patch.index()];
    if (original && link.neighbor && link.neighbor->patch == *original) link.max_angle = 0.0;
  }
  const Topology topology = InspectTopology(curves, ends, network.edges, duplicate_of, run);
  PM_RETURN_IF_ERROR(done(0.9));
  network.vertex_count = topology.vertex_count;
  network.boundary_loop_count = topology.boundary_loop_count;
  network.component_count = static_cast<int>(topology.components.size());
  network.euler_characteristic = topology.euler_characteristic;

  const Facts facts{curves, ends, corners, clusters, duplicate_of, nearly, meetings, topology, network.model};
  NetworkFindings findings(network.model, curves);
  ReportEdges(facts, network, findings);
  ReportFaceEdges(facts, network, findings);
  ReportMeetings(facts, network, findings);
  ReportVertices(facts, network, findings);
  ReportPatches(facts, findings);
  network.findings = findings.Take();
  network.duplicate_of = duplicate_of;
  return network;
}

absl::StatusOr<PatchNetwork> BuildNetwork(PatchModel model) {
  return BuildNetwork(std::move(model), RunContext(1));
}

}  // namespace patchmill
