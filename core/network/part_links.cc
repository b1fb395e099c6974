#include "core/network/part_links.h"

#include <algorithm>

#include "core/network/edge_links.h"
#include "core/network/open_edges.h"

namespace patchmill {

std::vector<PartLink> FindPartLinks(const PatchNetwork& network, const RunContext& run) {
  std::vector<PartLink> links;
  if (std::ranges::none_of(network.edges, &EdgeLink::on_t_junction)) return links;
  const EdgeCurves curves(network.model, run);
  if (run.Cancelled()) return links;
  std::vector<Vec3> edge_ends;
  std::vector<int> open;
  for (int e = 0; e < curves.count(); ++e) {
    edge_ends.push_back(curves.start(e));
    edge_ends.push_back(curves.end(e));
    const EdgeLink& link = network.edges[static_cast<std::size_t>(e)];
    if (!link.neighbor && !link.collapsed) open.push_back(e);
  }
  const auto ends = EdgeEndVertices(curves, MergeCorners(edge_ends, network.join_tolerance));
  for (const TJunction& t :
       InspectOpenEdges(curves, ends, open, network.join_tolerance, 0.0, run).t_junctions) {
    for (const int e : t.short_edges) {
      PartLink link{curves.edge(e), curves.edge(t.long_edge)};
      link.from = ClosestOnEdge(curves, t.long_edge, curves.start(e)).t;
      link.to = ClosestOnEdge(curves, t.long_edge, curves.end(e)).t;
      for (const Vec3& p : curves.samples(e)) {
        link.gap = std::max(link.gap, ClosestOnEdge(curves, t.long_edge, p).distance);
      }
      links.push_back(link);
    }
  }
  return links;
}

}  // namespace patchmill
