// Makes rest passes, which finish the places where the other passes leave more than the scallop. So the
// planner keeps [verification P2] before the verifier measures it.
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/location/locator.h"
#include "cam/path/reach/forced_steps.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/toolpath/cutter_path.h"
#include "cam/toolpath/segment_tree.h"
#include "core/base/run_context.h"

namespace patchmill {

struct RestPassParams {
  PassParams pass;
  double limit = 0.02;      // mm: a reachable point with more leftover than this is a spot to finish
  double tolerance = 0.01;  // mm: the whole error budget; ReachTolerance of it decides what is reachable
  // mm: the leftover of a place that is called covered may exceed the limit by this. Absent: kProofMargin of
  // the tolerance.
  std::optional<double> margin;
  ForcedSteps forced;  // surface that needs steps below min_step_fraction of these passes gets no rest passes
  int max_rounds = 6;
  const OperationLimits* operation_limits = nullptr;  // what is wanted and allowed; null: everything
  // For FindSpots when called by RemoveRedundantPasses: the moves that were removed. Only places that they
  // had finished count as spots, and only if they had left at least `removed_margin` (mm) less than the other
  // passes leave. Null: all places count.
  const SegmentTree* removed = nullptr;
  double removed_margin = 0.0;
  // For the same call: where removed and remaining moves both leave more than the limit, test only the
  // middles and corners of rectangles of a quarter of the flat step-over.
  bool coarse_where_both_exceed = false;
};

// Returns pencil and rest passes. Finds reachable surface points, of any slope, whose distance to the paths
// exceeds radius + limit (FindSpots). Follows the ridges of the leftover (at creases the two-contact curve
// itself) and adds certified passes there, until nothing reachable is above the limit or max_rounds is
// reached. Returns the added passes only. `reach` is the ReachLocator of this tolerance.
absl::StatusOr<std::vector<CutterPath>> RestPaths(const Locator& locator, const Locator& reach,
                                                  const std::vector<CutterPath>& paths,
                                                  const RestPassParams& params, const RunContext& run);

}  // namespace patchmill
