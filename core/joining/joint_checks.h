// Checks conditions between edges, normals and faces before tangents are made.
#pragma once

#include "core/joining/join_frame.h"

namespace patchmill {

// INCONSISTENT_NORMALS: a tangent of the edge leaves the plane of a face that meets another one smoothly
// there, or the faces on both sides of a smooth edge have different planes at an end.
void CheckPlanes(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const JoinedEdge& edge);

// LOOPED_EDGE, a warning: a cubic that crosses itself, seen in the plane of its chord and the end tangent
// that leaves the chord most [curves (14), (15)].
void CheckLoop(const JoinFrame& frame, const JoinedEdge& edge);

// PARALLEL_TANGENTS: two edges in line at a corner, which leave the patch without a tangent plane there.
void CheckCorners(const JoinFrame& frame, const std::vector<JoinedEdge>& edges);

// UNSUPPORTED_SCHEME: a face's scheme cannot make a patch of its edges.
void CheckSchemes(const JoinFrame& frame, const std::vector<JoinedEdge>& edges);

}  // namespace patchmill
