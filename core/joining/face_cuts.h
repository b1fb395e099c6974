// Faces of many sides, cut into pieces by inserted edges ([references: yamagata1990]: "a 5-sided region is
// split by inserting an edge curve"; [joining, section 2]).
#pragma once

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"

namespace patchmill {

// Most corners of a face with cuts.
inline constexpr int kMaxCutCorners = 100;

// The network with each face that has cuts replaced by its first piece, and the others after all faces, named
// by NetworkFace::of. Normals, twists and controls go with the pieces that have the corner or side. Ids of
// further pieces add "/2", "/3", ... Cost O(n) and of each face with n corners and m cuts O(n m). Codes:
// INVALID_CUT (not between two corners of one piece that have no side in common; a pushed face; too many
// corners).
CurveNetwork WithCutFaces(CurveNetwork network, Diagnostics& findings);

}  // namespace patchmill
