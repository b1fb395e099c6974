// PatchModel -> PatchNetwork: which patch edges meet, and everything that is wrong or remarkable about it.
//
// Edges of a quad patch, by index:  0: v=0 (u grows)   1: u=1 (v grows)   2: v=1 (u grows)   3: u=0 (v
// grows). Edges of a triangle:              0: t=0 (s grows)   1: s+t=1 from (1,0) to (0,1)   2: s=0 from
// (0,0) to (0,1).
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/typed_id.h"
#include "core/network/patch_model.h"

namespace patchmill {

struct PatchEdge {
  PatchId patch;
  int edge = 0;
  auto operator<=>(const PatchEdge&) const = default;
};

// One edge of one patch and its neighbour, if it has one.
struct EdgeLink {
  PatchEdge self;
  std::optional<PatchEdge> neighbor;
  bool reversed = false;       // the neighbour's parameter runs the other way
  bool collapsed = false;      // shorter than the join tolerance: a point
  bool on_t_junction = false;  // an open edge that lies along a longer edge of another patch
  double gap = 0.0;            // mm, largest distance found between the two edges
  double max_angle = 0.0;      // rad, largest angle between the (upward) normals found along the edge
};

struct PatchNetwork {
  PatchModel model;
  double join_tolerance = 0.0;  // mm, resolved
  std::vector<EdgeLink> edges;  // 4 (triangle 3) per patch, in order of patch, then edge index
  Diagnostics findings;  // OPEN_EDGE, COLLAPSED_EDGE, NEARLY_COLLAPSED_EDGE, GAP, T_JUNCTION, TANGENT_BREAK,
                         // NON_MANIFOLD_EDGE, DUPLICATE_PATCH, INCONSISTENT_ORIENTATION, ...
  int open_edge_count = 0;

  const EdgeLink& Link(PatchEdge edge) const;
  std::vector<int> first_edge;  // index into `edges` of each patch's edge 0
};

// Point of edge `edge` of `shape` at parameter t in [0,1], as native (u,v).
Vec2 EdgeParameters(const PatchShape& shape, int edge, double t);
int EdgeCount(const PatchShape& shape);

// Fails with INVALID_ARGUMENT (message: the first fault and how many more) only when ValidateModel finds a
// fault; topology is never an error, only a finding. Cost O(n log n).
absl::StatusOr<PatchNetwork> BuildNetwork(PatchModel model);

}  // namespace patchmill
