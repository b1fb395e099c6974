// Places the vertices on edges, and finds the tangent planes there [joining, section 6].
#pragma once

#include "core/joining/join_frame.h"

namespace patchmill {

// Puts each vertex on the chord of its edge, for means of normals before the curve is known.
void EstimateTPlaces(const EdgeTable& table, CurveNetwork& network);

// Gives the vertex its place on the finished curve in `edges`, and the faces along the parts their normal
// there. This is the normal of the leading face. At a crease it is their own, turned so that the curve lies
// in its plane. PARALLEL_TANGENTS where the leading face has no tangent plane.
void PlaceTVertex(const std::vector<JoinedEdge>& edges, const TVertex& t, JoinFrame& frame);

}  // namespace patchmill
