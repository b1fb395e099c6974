// What a height search walks over: rectangles of the pieces with their second-order models, as large as the
// ball's radius allows, under a tree of four children a node.
#pragma once

#include <cstdint>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/leaf_model.h"
#include "core/base/run_context.h"

namespace patchmill::internal {

// Four lanes of floats; arithmetic and comparisons work lane by lane (GCC and Clang vectors, same bits as
// scalar code).
using Float4 = float __attribute__((vector_size(16)));

// Four children and their boxes, rounded outward to floats. Empty lanes have boxes that nothing meets.
struct alignas(64) SearchNode {
  Float4 min_x, min_y, min_z, max_x, max_y, max_z;
  std::int32_t child[4];  // >= 0: node, < 0: leaf ~child
};

struct SearchLeaf {
  Vec3 center;  // oriented box as in SurfaceLeaf
  Eigen::Matrix3d axis;
  Vec3 half;
  LeafModel model;
  std::int32_t piece;
  float u0, u1, v0, v1;  // dyadic, hence exact
  Rect rect() const { return {u0, u1, v0, v1}; }
};

struct SearchTree {
  std::vector<SearchNode> nodes;  // nodes[0] is the root
  std::vector<SearchLeaf> leaves;
};

// Leaves are large where the distance to a centre resting there is proven convex (T6), and small where a ball
// of this radius may rest without that proof. About 3 us a leaf, parallel, deterministic. CANCELLED and
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<SearchTree> BuildSearchTree(const Surface& surface, double radius, const RunContext& run);

}  // namespace patchmill::internal
