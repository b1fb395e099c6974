// Closing the loop on [verification P2] while planning: where would passes leave more than the scallop, and
// what passes mend it.
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

struct RestPassParams : PassParams {
  double limit = 0.02;      // mm: leftover above this at a reachable point is a spot to mend
  double tolerance = 0.01;  // mm: the whole budget; reachable is what cam/limits/reach_tolerance.h says
  // mm: what is said to be covered may exceed the limit by this; absent: kProofMargin of the tolerance.
  std::optional<double> margin;
  ForcedSteps forced;  // ground that needs shorter steps than min_step_fraction of these is left
  int max_rounds = 6;
  const OperationLimits* operation_limits = nullptr;  // what is wanted and allowed; null: all of it
  // For FindSpots alone (RemoveRedundantPasses). Moves that are none of the passes any more: only places
  // count that
  // these finished, and left less of by more than `removed_margin` (mm). Null: all count.
  const SegmentTree* removed = nullptr;
  double removed_margin = 0.0;
  // Where both leave too much, only the middles and corners of rectangles of a quarter of the flat step are
  // asked.
  bool coarse_where_both_exceed = false;
};

// Crease passes and rest passes: finds reachable surface points whose distance to the paths exceeds radius +
// limit (FindSpots), whatever their slope, follows the ridges of the leftover (creases: the two-contact curve
// itself) and adds certified passes there, until nothing reachable is above the limit or max_rounds is up.
// Returns the added passes only. `reach`: ReachLocator of this tolerance.
absl::StatusOr<std::vector<CutterPath>> RestPaths(const Locator& locator, const Locator& reach,
                                                  const std::vector<CutterPath>& paths,
                                                  const RestPassParams& params, const RunContext& run);

}  // namespace patchmill
