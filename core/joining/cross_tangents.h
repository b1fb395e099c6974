// Cross-boundary tangents of all edges [joining, section 4], with faces along parts of an edge
// [joining, section 6].
#pragma once

#include "core/joining/join_frame.h"

namespace patchmill {

// Whether the tangents of a face that leads are cubic along an edge: what follows needs degree 4.
bool CubicAcross(const NetworkFace& face);

// Of a face that has its edge for itself, or leads there: along the edge, into the face. Linear; cubic where
// the face is pushed or given twists, and of a Hosaka face [joining (12)], there with breaks at vertices on
// the edge.
BezierChain LoneTangent(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const FaceSide& side);

// Where the blending function of a Hosaka face along the whole of a smooth edge has breaks, f(v) = v: at the
// vertices on it, from the edge's start.
std::vector<double> HosakaBreaks(const JoinedEdge& edge, const std::vector<JoinedEdge>& edges);

// Fills `tangents` of every edge. FOLDED_EDGE, PARALLEL_TANGENTS, HOSAKA_RATIO, INVALID_TWIST;
// UNSUPPORTED_CURVE where the second derivative of a smooth edge jumps. Returns early when `run` is
// cancelled.
void AddCrossTangents(const JoinFrame& frame, std::vector<JoinedEdge>& edges, const RunContext& run);

}  // namespace patchmill
