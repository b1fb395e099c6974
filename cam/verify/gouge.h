// P1: how deep the surface lies inside the ball, the shank above it, and a shank that is wider.
#pragma once

#include "cam/verify/extreme.h"
#include "cam/verify/segment_tree.h"

namespace patchmill {

struct GougeParams {
  double radius = 0.0;       // mm: ball and stock to leave
  double chord_error = 0.0;  // mm: what the segments may be off
  double certainty = 1e-3;   // mm
  double limit = kInfinity;  // mm: deeper is a violation
};

// Largest R - dist(p, moves swept upward) over the surface (ALGORITHMS 7 A). `tree` has Metric::kSwept.
// The distance to one strip is convex in p, so over a cell's hull it is nowhere below the smallest value that
// its tangent plane at the cell's middle takes at the control points. Cells are halved until no move can be
// deeper than what is known by more than `certainty`.
absl::StatusOr<Extremes> FindGouge(const Surface& surface, const std::vector<CellRect>& roots,
                                   const SegmentTree& tree, const GougeParams& params, const RunContext& run);

// Largest depth inside the cylinder of `shank_radius` (mm) that stands on the moves of `tree`
// (Metric::kShank). Known to max(certainty, 0.02 mm): cells are bounded by slope 1 only.
absl::StatusOr<Extremes> FindShankGouge(const Surface& surface, const std::vector<CellRect>& roots,
                                        const SegmentTree& tree, double shank_radius,
                                        const GougeParams& params, const RunContext& run);

}  // namespace patchmill
