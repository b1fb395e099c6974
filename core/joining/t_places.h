// Where vertices on edges lie, and the tangent planes there [joining, section 6].
#pragma once

#include "core/joining/join_frame.h"

namespace patchmill {

// On the chord, for means of normals before the curve is known.
void EstimateTPlaces(const EdgeTable& table, CurveNetwork& network);

// Gives the vertex its place on the finished curve in `edges`, and the faces along parts their normal there:
// that of the leading face; at a crease their own, with the curve laid into it. PARALLEL_TANGENTS where the
// leading face has no tangent plane.
void PlaceTVertex(const std::vector<JoinedEdge>& edges, const TVertex& t, JoinFrame& frame);

}  // namespace patchmill
