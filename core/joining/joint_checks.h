// What must hold between edges, normals and faces before tangents are made.
#pragma once

#include "core/joining/join_frame.h"

namespace patchmill {

// INCONSISTENT_NORMALS: a tangent of the edge leaves the plane of a face that meets another one smoothly
// there, or the faces on both sides of a smooth edge have different planes at an end.
void CheckPlanes(const JoinFrame& frame, const std::vector<JoinedEdge>& edges, const JoinedEdge& edge);

// LOOPED_EDGE, a warning: a cubic that crosses itself, seen across its chord and start tangent
// [curves (14), (15)].
void CheckLoop(const JoinFrame& frame, const JoinedEdge& edge);

// PARALLEL_TANGENTS: two edges in line at a corner leave the patch without tangent plane there.
void CheckCorners(const JoinFrame& frame, const std::vector<JoinedEdge>& edges);

// UNSUPPORTED_SCHEME: what a face's scheme cannot make of its edges.
void CheckSchemes(const JoinFrame& frame, const std::vector<JoinedEdge>& edges);

}  // namespace patchmill
