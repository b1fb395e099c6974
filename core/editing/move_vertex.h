// Moves a vertex with the ends of the curves that are given as they are.
#pragma once

#include "core/joining/curve_network.h"

namespace patchmill {

// The first or last two control points of a curve that ends at the vertex move with the vertex, so that
// its end tangent stays. Everything else follows when the network is joined again. The vertex must exist
// and lie on no edge.
void MoveVertexTo(CurveNetwork& network, int vertex, const Vec3& position);

}  // namespace patchmill
