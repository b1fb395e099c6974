// Which triangles of different pieces face each other across a common border.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/split_mesh.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// A triangle side: triangle `triangle` of piece `piece`, from its vertex `side` to the next one.
struct TriangleSide {
  int piece = 0;
  int triangle = 0;
  int side = 0;
};

struct Adjacency {
  TriangleSide side;
  int other_piece = -1;  // -1: nothing there (open border)
  int other_triangle = -1;
  bool across_seam = false;  // between different pieces
  double length = 0.0;       // mm, of the chord
};

// Every triangle side once per triangle (inner sides appear twice, once from each). Sides on a piece's border
// are matched by place: the neighbour is the border side of another piece that passes nearest to the middle
// of this one, within the network's join tolerance plus both sagittas. Order: piece, triangle, side.
// CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<Adjacency>> FindAdjacency(const Surface& surface,
                                                     const std::vector<SplitMesh>& meshes,
                                                     const RunContext& run);

}  // namespace patchmill
