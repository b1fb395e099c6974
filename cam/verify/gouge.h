// [verification P1, P3]: how deep the surface lies inside what moves: the ball and the shank above it, a
// shank that is wider, the ball with the stock around the surface.
#pragma once

#include "cam/toolpath/segment_tree.h"
#include "cam/verify/extreme.h"

namespace patchmill {

struct GougeParams {
  double radius = 0.0;       // mm: of the metric: ball and stock to leave; shank; ball and stock to keep off
  double chord_error = 0.0;  // mm: what the segments may be off
  double certainty = 1e-3;   // mm
  double limit = kInfinity;  // mm: deeper is a violation
};

// Largest radius - dist(p, moves) over the surface, dist being the tree's metric: Metric::kSwept
// ([verification, section 4]) or Metric::kShank. The distance to one move is convex in p, so over a cell's
// hull it is nowhere below the smallest value that its tangent plane at the cell's middle takes at the
// control points. Cells are halved until no move can be deeper than what is known by more than `certainty`.
absl::StatusOr<Extremes> FindGouge(const Surface& surface, const std::vector<CellRect>& roots,
                                   const SegmentTree& tree, const GougeParams& params, const RunContext& run,
                                   const char* stage);

}  // namespace patchmill
