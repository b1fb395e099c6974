// The curve of a network's edge along parts of drawn curves [crossing, section 5].
#pragma once

#include "core/crossing/curve_graph.h"
#include "core/curve/curve.h"

namespace patchmill {

struct EdgeWish {
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();                      // vertices
  Vec3 start_direction = Vec3::Zero(), end_direction = Vec3::Zero();  // unit, away from the vertex
  bool beside_triangle = false;                                       // at most degree 4, one span
  double tolerance = 0.0;
};

struct FittedEdge {
  Curve curve;
  double moved = 0.0;  // largest distance from the parts
};

FittedEdge FitGraphEdge(const GraphEdge& edge, const EdgeWish& wish);

}  // namespace patchmill
