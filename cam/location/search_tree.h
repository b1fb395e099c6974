// What a height search walks over: the surface's tree, packed, its leaves with their second-order models, and
// split further where the ball's radius asks for it.
#pragma once

#include <cstdint>
#include <vector>

#include "cam/location/leaf_model.h"

namespace patchmill::internal {

// Boxes rounded outward to floats.
struct SearchNode {
  float min_x, min_y, min_z, max_x, max_y, max_z;
  std::int32_t right;  // right child; the left one is the next node
  std::int32_t leaf;   // >= 0: index of a leaf, no children
};

struct SearchLeaf {
  Vec3 center;  // oriented box as in SurfaceLeaf
  Eigen::Matrix3d axis;
  Vec3 half;
  LeafModel model;
  Rect rect;
  std::int32_t piece;
};

struct SearchTree {
  std::vector<SearchNode> nodes;
  std::vector<SearchLeaf> leaves;
};

// Leaves on which the distance to a centre resting there is not proven convex (T6), though a ball of this
// radius may rest there, are halved up to twice. About 3 us a leaf, parallel, deterministic.
SearchTree BuildSearchTree(const Surface& surface, double radius);

}  // namespace patchmill::internal
