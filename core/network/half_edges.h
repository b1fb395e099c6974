// The joined patches as a half-edge mesh (OpenMesh): what only whole chains of edges can tell.
#pragma once

#include <optional>
#include <vector>

#include "core/network/edge_links.h"
#include "core/network/patch_network.h"

namespace patchmill {

struct Component {
  PatchId first;  // its patch of lowest index
  int patches = 0;
  int turned = 0;              // patches whose u x v looks to the other side than most
  std::optional<PatchId> odd;  // one of them
  bool one_sided = false;      // like a Moebius strip: no orientation fits
};
struct Topology {
  std::vector<Component> components;  // by first patch; duplicates belong to none
  std::vector<int> split_vertices;    // vertices at which fans touch without sharing an edge, ascending
  int vertex_count = 0;
  int boundary_loop_count = 0;
  int euler_characteristic = 0;  // vertices - edges + faces, all components together
};

// `links` as LinkEdges gives them; only mutual links join. Meaningless when the run was cancelled meanwhile.
Topology InspectTopology(const EdgeCurves& curves, const std::vector<EdgeEnds>& ends,
                         const std::vector<EdgeLink>& links,
                         const std::vector<std::optional<PatchId>>& duplicate_of, const RunContext& run);

}  // namespace patchmill
