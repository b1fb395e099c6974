// Makes a PatchNetwork from a PatchModel: which patch edges meet, and all faults and findings about them.
//
// Edges by index, and the parameter that grows along each:
//
//   quad      0: v=0 (u)   1: u=1 (v)                         2: v=1 (u)                 3: u=0 (v)
//   triangle  0: t=0 (s)   1: s+t=1 from (1,0) to (0,1) (t)   2: s=0 from (0,0) to (0,1) (t)
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/base/typed_id.h"
#include "core/network/patch_model.h"

namespace patchmill {

struct PatchEdge {
  PatchId patch;
  int edge = 0;
  auto operator<=>(const PatchEdge&) const = default;
};

// One edge of one patch and its neighbour, if it has one. Neighbours are mutual except where a finding says
// NON_MANIFOLD_EDGE or DUPLICATE_PATCH. There a further edge names one of the two that are linked.
struct EdgeLink {
  PatchEdge self;
  std::optional<PatchEdge> neighbor;
  bool reversed = false;   // the neighbour's parameter runs the other way
  bool collapsed = false;  // stays within the join tolerance of its start: a point
  // It has no single neighbour and yet is no border: it lies along a longer edge of another patch, or shorter
  // ones cover all of it.
  bool on_t_junction = false;
  double gap = 0.0;        // mm, largest distance found between the two edges
  double max_angle = 0.0;  // rad, largest angle found between the two patches' normals along the edge, both
                           // turned to one side of the joined sheet: 0 smooth, pi folded back
};

// An edge that lies all along a longer one of another patch: one link of a T-junction.
struct PartLink {
  PatchEdge part, whole;
  double from = 0.0, to = 1.0;  // parameters of the whole at the start and end of the part; may run backwards
  double gap = 0.0;             // mm, largest distance found of the part from the whole
  double max_angle = 0.0;       // rad, as EdgeLink::max_angle, along the part
};

struct PatchNetwork {
  PatchModel model;
  double join_tolerance = 0.0;       // mm, resolved
  std::vector<EdgeLink> edges;       // 4 (triangle 3) per patch, in order of patch, then edge index
  std::vector<PartLink> part_links;  // by whole, then by part: the edges that T_JUNCTION findings report
  // Ordered by code, then by edge; at most 1000 of a code and one line that counts the rest. Patches that are
  // parts of faces have findings about their faces: one OPEN_EDGE for each face, one TANGENT_BREAK for each
  // two that meet, and none about edges inside a face.
  //   OPEN_EDGE                 no neighbour: a border (info)
  //   COLLAPSED_EDGE            a point, a pole (info)
  //   NEARLY_COLLAPSED_EDGE     longer than the join tolerance, but negligible beside its patch; kept so
  //   GAP                       two open edges run side by side, farther apart than the join tolerance
  //   T_JUNCTION                a long edge meets shorter ones (info)
  //   TANGENT_BREAK             max_angle above kTangentBreak: a crease (info)
  //   NON_MANIFOLD_EDGE         three or more patches share an edge
  //   NON_MANIFOLD_VERTEX       fans of patches touch in a point
  //   DUPLICATE_PATCH           the same surface as an earlier patch
  //   INCONSISTENT_ORIENTATION  neighbours run u x v to opposite sides (info; no algorithm needs a side)
  //   SEARCH_LIMITED            too many open edges lie together for a search of all gaps and T-junctions
  Diagnostics findings;
  // By patch: the earlier patch whose copy it is, see DUPLICATE_PATCH.
  std::vector<std::optional<PatchId>> duplicate_of;
  // mm, of the edges between faces that TANGENT_BREAK findings report: those that stick out, and inner
  // corners.
  double convex_length = 0.0, concave_length = 0.0;
  int open_edge_count = 0;      // edges with an OPEN_EDGE finding
  int t_junction_count = 0;     // long edges with a T_JUNCTION finding
  int vertex_count = 0;         // corners after joining
  int boundary_loop_count = 0;  // closed chains of unlinked edges
  int component_count = 0;      // pieces joined by edges
  int euler_characteristic =
      0;  // vertices - edges + faces: 2 a sphere, 0 a torus, 1 a sheet; one-sided: cut open

  const EdgeLink& Link(PatchEdge edge) const;
  std::vector<int> first_edge;  // index into `edges` of each patch's edge 0
};

inline constexpr double kTangentBreak = Radians(0.5);

// Point of edge `edge` of `shape` at parameter t in [0,1], as native (u,v).
Vec2 EdgeParameters(const PatchShape& shape, int edge, double t);
int EdgeCount(const PatchShape& shape);

// Fails with INVALID_ARGUMENT (message: the first fault and how many more) only when ValidateModel finds a
// fault. Topology is never an error, only a finding. Cost O(n log n).
// Two edges are joined when every point tried on either one lies within the join tolerance of the other:
// their ends and at least 7 points between. Each is compared with the closest point, so parametrisations may
// differ.
absl::StatusOr<PatchNetwork> BuildNetwork(PatchModel model);
absl::StatusOr<PatchNetwork> BuildNetwork(PatchModel model, const RunContext& run);  // run's threads, cancel

}  // namespace patchmill
