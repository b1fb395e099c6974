// A joined network ready to evaluate, with a bounds hierarchy over sub-rectangles of its pieces.
#pragma once

#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/base/typed_id.h"
#include "core/network/patch_network.h"
#include "core/patch/piece.h"
#include "core/surface/box_node.h"
#include "core/surface/surface_leaf.h"

namespace patchmill {

// A point on the surface: its piece, its parameters there and its place.
struct SurfacePoint {
  PieceId piece;
  double u = 0.0, v = 0.0;
  Vec3 p = Vec3::Zero();
};

// Node of a binary tree in depth-first order. The left child of an inner node is the next node, the right
// child is `right`.
struct SurfaceNode {
  Box3 box;  // of all control points below
  std::int32_t right = 0;
  std::int32_t leaf = -1;  // >= 0: index into leaves, no children
};

// Can be moved, not copied: pieces point to the patches of the network's model.
struct Surface {
  Surface() = default;
  Surface(Surface&&) = default;
  Surface& operator=(Surface&&) = default;

  // The model must not change, because pieces of some kinds are evaluated by it. No net is kept twice: a
  // BezierPatch of one piece in its own parameters has degrees here, but no points; the piece's net has them.
  // Use Evaluate and ShapeOf for a whole patch of any kind.
  PatchNetwork network;
  std::vector<Piece> pieces;
  std::vector<PieceId> first_piece;  // index: patch
  std::vector<SurfaceLeaf> leaves;
  std::vector<SurfaceNode> nodes;        // nodes[0] is the root
  std::vector<BoxNode> box_nodes;        // the same tree with four children per node, which closest.h walks
  Box3 box;                              // union of the leaf bounds
  double scale = 1.0;                    // largest absolute coordinate; the rounding slack is 1e-12 of it
  std::vector<PatchId> two_sided_walls;  // AirSides::undecided

  const Piece& piece(PieceId id) const { return pieces[id.index()]; }
};

struct SurfaceParams {
  double leaf_thickness = 0.02;  // mm, > 0; leaves are split until half().z() is at most this
  int max_depth = 10;            // halvings of a piece per direction, 0..20
  // Limits the memory of the bounds (about 250 B per leaf with its nodes). If more leaves are needed, the
  // thickness is raised by factors of 4 until they suffice. Coarse leaves cost time, never correctness. Each
  // piece has at least one leaf.
  int max_leaves = 1'000'000;
};

// Builds pieces, leaves and trees. The network must be placed (mm, machine axes) and its model valid
// (ValidateModel). Bezier patches, and B-spline patches of one knot rectangle, give their points to their
// pieces; ShapeOf returns them. Deterministic, parallel over pieces. Cost about 1 us per leaf.
// INVALID_ARGUMENT for a model without patches or bad params; CANCELLED and DEADLINE_EXCEEDED from `run`.
// Stage names for progress: "pieces", "bounds", "bounds: tree", "bounds: boxes".
absl::StatusOr<Surface> BuildSurface(PatchNetwork network, const SurfaceParams& params,
                                     const RunContext& run);

inline SurfaceJet Evaluate(const Surface& s, PieceId id, double u, double v) {
  return Evaluate(s.piece(id), u, v);
}
// Evaluates in the patch's own parameters, like Evaluate of its shape.
SurfaceJet Evaluate(const Surface& s, PatchId id, double u, double v);

// A copy of the patch with all its points. A B-spline patch of one knot rectangle comes back as the Bezier
// patch that it is. The points of a rational one are exact to 2.3e-16 of their size.
PatchShape ShapeOf(const Surface& s, PatchId id);

// Outer bounds of any sub-rectangle, computed afresh from its net ([location, section 6]). Certificates
// subdivide with them. Cost O(points).
RectBounds BoundNet(const BernsteinNet& net);

}  // namespace patchmill
