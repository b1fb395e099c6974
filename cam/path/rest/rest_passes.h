// Rest passes close the loop on [verification P2] while planning. They finish the places where passes would
// leave more than the scallop.
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
  double tolerance = 0.01;  // mm: the whole budget; cam/limits/reach_tolerance.h says what is reachable
  // mm: a place called covered may exceed the limit by this; absent: kProofMargin of the tolerance.
  std::optional<double> margin;
  ForcedSteps forced;  // surface that needs shorter steps than min_step_fraction of these is left
  int max_rounds = 6;
  const OperationLimits* operation_limits = nullptr;  // what is wanted and allowed; null: everything
  // For FindSpots only (RemoveRedundantPasses). These are moves that are not passes any more. Only places
  // count that they finished, and of which they left less by more than `removed_margin` (mm). Null: all
  // places count.
  const SegmentTree* removed = nullptr;
  double removed_margin = 0.0;
  // Where both leave too much, only the middles and corners of rectangles of a quarter of the flat step-over
  // are tested.
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
