#include "core/network/part_links.h"

#include <algorithm>

#include "core/network/edge_angles.h"

namespace patchmill {

std::vector<PartLink> FindPartLinks(const EdgeCurves& curves, const std::vector<EdgeLink>& edges,
                                    const std::vector<TJunction>& junctions, const RunContext& run) {
  const auto taken = [&edges](int e) { return edges[static_cast<std::size_t>(e)].neighbor.has_value(); };
  std::vector<PartLink> links;
  for (const TJunction& t : junctions) {
    if (taken(t.long_edge)) continue;
    for (const int e : t.short_edges) {
      if (run.Cancelled()) return links;
      if (taken(e)) continue;
      PartLink link{curves.edge(e), curves.edge(t.long_edge)};
      link.from = ClosestOnEdge(curves, t.long_edge, curves.start(e)).t;
      link.to = ClosestOnEdge(curves, t.long_edge, curves.end(e)).t;
      for (const Vec3& p : curves.samples(e)) {
        link.gap = std::max(link.gap, ClosestOnEdge(curves, t.long_edge, p).distance);
      }
      link.max_angle = AngleAlong(curves, e, t.long_edge, link.to < link.from);
      links.push_back(link);
    }
  }
  return links;
}

}  // namespace patchmill
