// Checks the vertices and faces of a curve network.
#pragma once

#include "core/joining/network_findings.h"

namespace patchmill {

// Codes: INVALID_REFERENCE, FACE_SIDES (with the edges to insert), ZERO_LENGTH_EDGE (a face names a vertex
// twice), INVALID_T_VERTEX. Returns false if the indices must not be used.
bool CheckReferences(const CurveNetwork& network, const NetworkWriter& findings);

// Codes: NOT_FINITE, TOO_LARGE, INVALID_NORMAL, UNUSED_VERTEX, INVALID_JOIN_TOLERANCE, DUPLICATE_VERTEX.
// Needs sound references. Returns false if vertices lie in one place: then it is not known what meets there.
bool CheckVertices(const CurveNetwork& network, const NetworkWriter& findings);

}  // namespace patchmill
