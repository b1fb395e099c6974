// Surface: a joined network ready to evaluate, with a bounds hierarchy over sub-rectangles of its pieces.
#pragma once

#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/base/typed_id.h"
#include "core/network/patch_network.h"
#include "core/patch/piece.h"

namespace patchmill {

// A point on the surface: piece, its parameters, its place.
struct SurfacePoint {
  PieceId piece;
  double u = 0.0, v = 0.0;
  Vec3 p = Vec3::Zero();
};

// A sub-rectangle of a piece with outer bounds, all proven from the Bernstein net (ALGORITHMS 1, 2.2).
struct SurfaceLeaf {
  PieceId piece;
  float u0 = 0, u1 = 1, v0 = 0, v1 = 1;  // dyadic, hence exact
  // Oriented box: |(x - center) . axis[k]| <= half[k]; axis[2] is the leaf's mean normal.
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3f axis = Eigen::Matrix3f::Identity();  // columns
  Eigen::Vector3f half = Eigen::Vector3f::Zero();      // rounded outward
};

// Node of a binary tree in depth-first order. Inner: left child is the next node, right child is `right`.
struct SurfaceNode {
  Box3 box;  // of all control points below
  std::int32_t right = 0;
  std::int32_t leaf = -1;  // >= 0: index into leaves, no children
};

struct Surface {
  PatchNetwork network;
  std::vector<Piece> pieces;
  std::vector<PieceId> first_piece;  // of each patch
  std::vector<SurfaceLeaf> leaves;
  std::vector<SurfaceNode> nodes;  // nodes[0] is the root
  Box3 box;                        // tight to leaf bounds
  double scale = 1.0;              // largest absolute coordinate; rounding slack is 1e-12 of it

  const Piece& piece(PieceId id) const { return pieces[id.index()]; }
};

struct SurfaceParams {
  double leaf_thickness = 0.02;  // mm: leaves are split until their control points lie this close to a plane
  int max_depth = 10;            // halvings of a piece per direction
};

// Builds pieces, leaves and tree. The network must be placed (mm, machine axes). Deterministic, parallel over
// pieces.
absl::StatusOr<Surface> BuildSurface(PatchNetwork network, const SurfaceParams& params,
                                     const RunContext& run);

inline SurfaceJet Evaluate(const Surface& s, PieceId id, double u, double v) {
  return Evaluate(s.piece(id), u, v);
}

// Outer bounds of any sub-rectangle, computed afresh from its net: what certificates subdivide with.
struct RectBounds {
  Box3 box;
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d axis = Eigen::Matrix3d::Identity();  // columns; axis.col(2) the mean normal
  Vec3 half = Vec3::Zero();
};
RectBounds BoundNet(const BernsteinNet& net);

}  // namespace patchmill
