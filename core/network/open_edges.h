// Relations between open edges: T-junctions, gaps, and matches that corner merging missed.
#pragma once

#include <vector>

#include "core/network/edge_curves.h"
#include "core/network/edge_links.h"

namespace patchmill {

struct TJunction {
  int long_edge = 0;
  std::vector<int> short_edges;  // lie along it; may be empty when edges only overlap in part
};
struct EdgeGap {
  int edge = 0, other = 0;
  bool reversed = false;
  double distance = 0.0;  // mm; if within the join tolerance, the edges are neighbours after all
};
struct OpenEdgeReport {
  std::vector<TJunction> t_junctions;  // by long edge
  std::vector<bool> covered;           // of each edge: on a T-junction all along
  std::vector<EdgeGap> gaps;           // by edge; each edge in at most one
  bool limited = false;                // the search budget ran out
};

struct MeetingLimits {
  double tolerance = 0.0;  // mm, > 0: the join tolerance
  // mm, >= 0: two edges farther apart are not meant to meet; nor are edges farther apart than a tenth of the
  // shorter one.
  double gap = 0.0;
};

// `open`: edges without neighbour that are neither collapsed nor nearly so. Cost O(n log n) for models whose
// open edges do not pile up. After a budget of some seconds the search gives up (`limited`).
OpenEdgeReport InspectOpenEdges(const EdgeCurves& curves, const std::vector<EdgeEnds>& ends,
                                const std::vector<int>& open, const MeetingLimits& limits,
                                const RunContext& run);

}  // namespace patchmill
