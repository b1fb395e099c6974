// The borders of regions as lines, each of one kind between two regions, and the nodes where they meet.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/border/border_arcs.h"
#include "cam/region/map/region_map.h"

namespace patchmill {

struct BorderNet {
  std::vector<BorderLine> lines;
  std::vector<Vec3> nodes;
};

// Of all sides between different regions, which `component_of[piece][triangle]` (-1 none) are components of
// (`component_region`, rising), along the `points` of the `arcs` of the split; every side once. Of the
// `regions` kind, slope and reason are read: what makes a side is the field on whose zero curve or limit it
// lies, one that differs across it first. Ends nearer than twice the join tolerance are one place, and where
// a seam is cut differently on its two sides lines run on across the gap (no longer than the longest side on
// a seam). Lines are ordered by their first side, nodes as lines come to them. CANCELLED, DEADLINE_EXCEEDED
// from `run`.
absl::StatusOr<BorderNet> FindBorderLines(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                          const AdjacencyList& adjacency, const BorderArcs& arcs,
                                          const BorderPoints& points,
                                          const std::vector<std::vector<int>>& component_of,
                                          const std::vector<int>& component_region,
                                          const std::vector<Region>& regions, const RunContext& run);

}  // namespace patchmill
