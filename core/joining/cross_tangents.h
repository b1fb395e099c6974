// Cross-boundary tangents of all edges [joining, section 4], including faces along parts of an edge [joining,
// section 6].
#pragma once

#include "core/joining/join_frame.h"

namespace patchmill {

// Whether the tangents of a leading face are cubic along an edge. A face that follows them then needs degree
// 4.
bool CubicAcross(const NetworkFace& face);

// The tangent across an edge, into the face, for a face that has the edge alone or leads there; given along
// the edge. It is linear. It is cubic if the face is pushed or has given twists, and for a Hosaka face
// [joining (12)], there with breaks at the vertices on the edge.
BezierChain LoneTangent(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const FaceSide& side);

// The breaks, f(v) = v, of the blending function of a Hosaka face along the whole of a smooth edge. They are
// the places of the vertices on the edge, from its start.
std::vector<double> HosakaBreaks(const JoinedEdge& edge, const std::vector<JoinedEdge>& edges);

// Fills `tangents` of every edge. Reports FOLDED_EDGE, PARALLEL_TANGENTS, HOSAKA_RATIO, INVALID_TWIST, and
// UNSUPPORTED_CURVE where the second derivative of a smooth edge jumps. Returns early when `run` is
// cancelled.
void AddCrossTangents(const JoinFrame& frame, std::vector<JoinedEdge>& edges, const RunContext& run);

}  // namespace patchmill
