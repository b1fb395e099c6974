// Finds how deep the surface lies inside moving bodies [verification P1, P3]: the ball and its upward sweep,
// a wider shank, or the ball enlarged by the stock.
#pragma once

#include "cam/toolpath/segment_tree.h"
#include "cam/verify/extreme.h"

namespace patchmill {

struct GougeParams {
  double radius = 0.0;       // mm, of the body: ball + stock to leave, shank, or ball + stock allowance
  double chord_error = 0.0;  // mm, error of the segments
  double certainty = 1e-3;   // mm
  double limit = kInfinity;  // mm; a deeper place is a violation
};

// Largest radius + chord_error - distance(p, moves) over the surface. The distance is that of the tree's
// metric, which is not Metric::kPath [verification, section 4]. The distance to one move is convex in p. So
// over a cell's hull it is nowhere below the smallest value that the tangent plane at the cell's middle takes
// at the control points [verification T9]. Cells are halved until no move can be deeper than the value found
// by more than `certainty`. The roots must cover the surface; `stage` names the progress.
absl::StatusOr<Extremes> FindGouge(const RootedSurface& rooted, const SegmentTree& tree,
                                   const GougeParams& params, const RunContext& run, const char* stage);

}  // namespace patchmill
