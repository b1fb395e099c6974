// Finds how deep the surface lies inside a moving body [verification P1, P3]. The body is the ball with its
// upward sweep, a wider shank, or the ball enlarged by the stock allowance.
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

// Returns the largest value of radius + chord_error - distance(p, moves) over the surface points p. The
// distance is that of the tree's metric, which is not Metric::kPath [verification, section 4]. For one move
// it is a convex function of p. So over the hull of a cell it is bounded from below by its tangent plane at
// the middle of the cell, whose smallest value is at a control point [verification T9]. Cells are halved
// until no move can give a value that exceeds the largest one found by more than `certainty`. The roots must
// cover the surface. `stage` is the name under which progress is reported.
absl::StatusOr<Extremes> FindGouge(const RootedSurface& rooted, const SegmentTree& tree,
                                   const GougeParams& params, const RunContext& run, const char* stage);

}  // namespace patchmill
