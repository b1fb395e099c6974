// Cuts a row of quads in two by a new line of edges [editing, section 9].
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "core/joining/join_network.h"

namespace patchmill {

// The side `start` `end` of a face is cut at a parameter of its curve, the opposite side of the face
// likewise, and so on through the row of quads on both sides of the edge, until a border or its own
// beginning.
struct FaceSplit {
  int start = 0, end = 0;  // vertices of an edge
  double at = 0.5;         // [0.05, 0.95], from `start`
};

// What became of a face: the face itself is the half at its first corner, `made` the other one.
struct DividedFace {
  int face = 0, made = 0;
  bool along_u = true;  // the cut is at u = `at`, else at v = `at`
  double at = 0.5;
};

// `joined` was made from `network`, whose lines across the cut have been turned into edges (FreeLines). All
// new vertices and faces come after the old ones. The curves that are cut stay as they are, exactly.
// INVALID_ARGUMENT "<at> ..." if a face of the row is no quad or has cuts or bulges, or if vertices lie on
// an edge of it.
absl::StatusOr<std::vector<DividedFace>> SplitFaces(const FaceSplit& split, const JoinedNetwork& joined,
                                                    const std::string& at, CurveNetwork& network);

// The edges of `joined` that the cut crosses. Same errors.
absl::StatusOr<std::vector<int>> CrossedEdges(const FaceSplit& split, const JoinedNetwork& joined,
                                              const CurveNetwork& network, const std::string& at);

}  // namespace patchmill
