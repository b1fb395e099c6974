// Cross-boundary tangents of all edges (METHODS 1.3-1.5), with faces along parts of an edge (3.3).
#pragma once

#include "core/joining/join_frame.h"

namespace patchmill {

// Of a face that has its edge for itself, or leads there: along the edge, into the face. Linear; cubic where
// the face is pushed.
BezierCurve LoneTangent(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const FaceSide& side);

// Fills `tangents` of every edge. FOLDED_EDGE, PARALLEL_TANGENTS. Returns early when `run` is cancelled.
void AddCrossTangents(const JoinFrame& frame, std::vector<JoinedEdge>& edges, const RunContext& run);

}  // namespace patchmill
