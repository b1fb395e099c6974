// Whether the vertices and faces of a curve network can be what they say.
#pragma once

#include "core/joining/network_findings.h"

namespace patchmill {

// Codes: INVALID_REFERENCE, FACE_SIDES (with the edges to insert), ZERO_LENGTH_EDGE (a face names a vertex
// twice), INVALID_T_VERTEX. False when indices must not be followed.
bool CheckReferences(const CurveNetwork& network, const NetworkWriter& findings);

// Codes: NOT_FINITE, TOO_LARGE, INVALID_NORMAL, UNUSED_VERTEX, INVALID_JOIN_TOLERANCE, DUPLICATE_VERTEX.
// Needs sound references. False when vertices lie in one place: what meets there is not known.
bool CheckVertices(const CurveNetwork& network, const NetworkWriter& findings);

}  // namespace patchmill
