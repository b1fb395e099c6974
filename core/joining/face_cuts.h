// Cuts faces of many sides into pieces by inserted edges ([references: yamagata1990]: "a 5-sided region is
// split by inserting an edge curve"; [joining, section 2]).
#pragma once

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"

namespace patchmill {

// Largest number of corners of a face with cuts.
inline constexpr int kMaxCutCorners = 100;

// The network with each face that has cuts replaced by its first piece. The other pieces come after all
// faces; their NetworkFace::of names the face. Normals, twists and controls go to the pieces that have the
// corner or side. Ids of further pieces add "/2", "/3", ... Cost O(n), plus O(n m) for a face with n corners
// and m cuts. Code: INVALID_CUT (not between two corners of one piece that have no side in common; a pushed
// face; too many corners).
CurveNetwork WithCutFaces(CurveNetwork network, Diagnostics& findings);

}  // namespace patchmill
