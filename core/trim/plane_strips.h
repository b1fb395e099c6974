// A face on a plane as exact rational patches: trapezoids between its own borders [trimming, section 6].
//
// Lines, conic sections and splines stay what they are. The face is cut by walls, straight lines at right
// angles to its longest straight edge, through every corner and every place where a border turns back.
// Between two walls one border lies above the other. A patch reaches from a border to a straight line along
// parallel rulings, so it never folds. Where both borders are curved, a straight line is laid between them.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/brep/brep_model.h"
#include "core/patch/piece.h"
#include "core/trim/border_trace.h"

namespace patchmill {

struct PlanePatches {
  std::vector<BernsteinNet> nets;  // u x v is the frame's x cross y
  double gap = 0.0;  // mm, largest distance of an edge from the plane, or of its end from the next edge
  // Parameters at which each edge's border was cut, by the place of the edge's use in the loops, ascending.
  std::vector<std::vector<double>> breaks;
};

// FAILED_PRECONDITION if a loop is open by more than 0.05 mm, or borders cross. Cost O(n^2) in the spans of
// the borders.
absl::StatusOr<PlanePatches> CutPlane(const BrepFrame& frame, const std::vector<BrepLoop>& loops,
                                      const EdgeCurveTable& curves, const RunContext& run);

}  // namespace patchmill
