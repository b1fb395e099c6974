// Finds edges that are the same curve, patches that are the same surface, and the neighbours that follow.
#pragma once

#include <optional>
#include <vector>

#include "core/network/corner_vertices.h"
#include "core/network/edge_curves.h"
#include "core/network/patch_network.h"

namespace patchmill {

// The ends of each edge as vertices.
struct EdgeEnds {
  int start = 0, end = 0;
};
std::vector<EdgeEnds> EdgeEndVertices(const EdgeCurves& curves, const CornerVertices& corners);

// Groups of edges that agree within the tolerance. Between the same two vertices at most 64 different curves
// are distinguished (only hostile models have more). Further ones stay alone.
struct EdgeClusters {
  std::vector<int> cluster_of;            // of each edge; -1 when it is collapsed
  std::vector<bool> reversed;             // of each edge, against the first one of its cluster
  std::vector<std::vector<int>> members;  // ascending
};
EdgeClusters ClusterEdges(const EdgeCurves& curves, const std::vector<EdgeEnds>& ends, double tolerance,
                          const RunContext& run);

// For each patch an earlier patch that is the same surface, up to turning or mirroring its parameters.
std::vector<std::optional<PatchId>> FindDuplicates(const PatchModel& model, const EdgeCurves& curves,
                                                   const EdgeClusters& clusters, double tolerance);

// The link table. EdgeLink says what it holds where more than two edges meet.
std::vector<EdgeLink> LinkEdges(const EdgeCurves& curves, const EdgeClusters& clusters,
                                const std::vector<std::optional<PatchId>>& duplicate_of, double tolerance,
                                const RunContext& run);

}  // namespace patchmill
