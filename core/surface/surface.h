// Surface: a joined network ready to evaluate, with a bounds hierarchy over sub-rectangles of its pieces.
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

// A point on the surface: piece, its parameters, its place.
struct SurfacePoint {
  PieceId piece;
  double u = 0.0, v = 0.0;
  Vec3 p = Vec3::Zero();
};

// Node of a binary tree in depth-first order. Inner: left child is the next node, right child is `right`.
struct SurfaceNode {
  Box3 box;  // of all control points below
  std::int32_t right = 0;
  std::int32_t leaf = -1;  // >= 0: index into leaves, no children
};

// May be moved, not copied: pieces point to the patches of the network's model.
struct Surface {
  Surface() = default;
  Surface(Surface&&) = default;
  Surface& operator=(Surface&&) = default;

  // The model must stay as it is: pieces of some kinds are evaluated by it. No net is kept twice: a
  // BezierPatch in it has its degrees but no points, its piece's net has them. What asks for the whole
  // patch, whatever its kind, goes through Evaluate and ShapeOf.
  PatchNetwork network;
  std::vector<Piece> pieces;
  std::vector<PieceId> first_piece;  // of each patch
  std::vector<SurfaceLeaf> leaves;
  std::vector<SurfaceNode> nodes;        // nodes[0] is the root
  std::vector<BoxNode> box_nodes;        // the same tree, four children a node: what closest.h walks
  Box3 box;                              // tight to leaf bounds
  double scale = 1.0;                    // largest absolute coordinate; rounding slack is 1e-12 of it
  std::vector<PatchId> two_sided_walls;  // AirSides::undecided

  const Piece& piece(PieceId id) const { return pieces[id.index()]; }
};

struct SurfaceParams {
  double leaf_thickness = 0.02;  // mm, > 0: leaves are split until half().z() is at most this
  int max_depth = 10;            // halvings of a piece per direction, 0..20
  // Bounds memory (about 250 B a leaf with its nodes): when more would be needed, the thickness is raised by
  // factors of 4 until they suffice. Coarse leaves cost time, never correctness. At least one per piece.
  int max_leaves = 1'000'000;
};

// Builds pieces, leaves and tree. The network must be placed (mm, machine axes) and its model sound
// (ValidateModel); its Bezier patches, and B-spline patches of one knot rectangle, leave their points to
// their pieces (ShapeOf gives them back). Deterministic, parallel over pieces. Cost about 1 us a leaf.
// INVALID_ARGUMENT for a model without patches or bad params; CANCELLED and DEADLINE_EXCEEDED from `run`.
// Stage names for progress: "pieces", "bounds", "bounds: tree", "bounds: boxes".
absl::StatusOr<Surface> BuildSurface(PatchNetwork network, const SurfaceParams& params,
                                     const RunContext& run);

inline SurfaceJet Evaluate(const Surface& s, PieceId id, double u, double v) {
  return Evaluate(s.piece(id), u, v);
}
// In the patch's own parameters, as Evaluate of its shape.
SurfaceJet Evaluate(const Surface& s, PatchId id, double u, double v);

// A copy of the patch with all its points. A B-spline patch of one knot rectangle comes back as the Bezier
// patch it is; points of a rational one to 2.3e-16 of their size.
PatchShape ShapeOf(const Surface& s, PatchId id);

// Outer bounds of any sub-rectangle, computed afresh from its net ([location, section 6]): what certificates
// subdivide with. Cost O(points).
RectBounds BoundNet(const BernsteinNet& net);

}  // namespace patchmill
