// Measures how well joined patches meet: gaps, angles between normals and differences of curvature, at dense
// points of every joint.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/network/patch_network.h"

namespace patchmill {

struct EdgeContinuity {
  PatchEdge a, b;          // a < b; if `part`, a is the shorter edge
  bool part = false;       // a lies along a part of b, a T-junction
  double max_gap = 0.0;    // mm, between the two edge curves
  double gap_at = 0.0;     // parameter of edge a there
  double max_angle = 0.0;  // rad, between the normals, both turned to one side of the sheet; 0 smooth
  double angle_at = 0.0;
  // 1/mm: largest difference of the two normal curvatures in any one direction. Measured between the ends of
  // the edge (blended patches have none at corners) and where the angle is not above kTangentBreak.
  double max_curvature_gap = 0.0;
  double curvature_gap_at = 0.0;
  double max_curvature = 0.0;  // 1/mm: largest |normal curvature| there, of either patch
};

struct ContinuityReport {
  std::vector<EdgeContinuity> edges;  // every pair of linked edges once, by a; then the parts of longer edges
  int samples = 0;                    // per edge
};

// Measures at `steps` + 1 points (1..10,000) at equal steps of edge a's parameter, both ends included. On
// edge b it takes the point of equal parameter, or the closest one where that is farther than 1e-9 of the
// edge. Exact at these points: gap to 1e-15 of the model, angle to 1e-14 rad, curvatures to about 1e-13 of
// 1/edge on regular patches. Parallel over edges. CANCELLED and DEADLINE_EXCEEDED from `run`.
//
// It evaluates the network's own model, so call it before a Surface takes that.
absl::StatusOr<ContinuityReport> MeasureContinuity(const PatchNetwork& network, int steps,
                                                   const RunContext& run);

}  // namespace patchmill
