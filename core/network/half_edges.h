// The joined patches as a half-edge mesh (OpenMesh), for results that need whole chains of edges.
#pragma once

#include <optional>
#include <vector>

#include "core/network/edge_links.h"
#include "core/network/patch_network.h"

namespace patchmill {

struct Component {
  PatchId first;  // its patch of lowest index
  int patches = 0;
  int turned = 0;              // patches whose u x v points to the other side than that of most
  std::optional<PatchId> odd;  // one of them
  bool one_sided = false;      // as a Moebius strip: no orientation fits
};
struct Topology {
  std::vector<Component> components;  // by first patch; duplicates belong to none
  std::vector<int> split_vertices;    // vertices at which fans touch without sharing an edge, ascending
  int vertex_count = 0;
  int boundary_loop_count = 0;
  int euler_characteristic = 0;  // vertices - edges + faces, all components together
};

// `links` are those of LinkEdges; only mutual links join. The result is meaningless if `run` was cancelled
// meanwhile.
Topology InspectTopology(const EdgeCurves& curves, const std::vector<EdgeEnds>& ends,
                         const std::vector<EdgeLink>& links,
                         const std::vector<std::optional<PatchId>>& duplicate_of, const RunContext& run);

}  // namespace patchmill
