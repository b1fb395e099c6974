// Zig-zag passes over the gentle ground: scan lines side by side, spaced for the scallop by the centre
// formula, straight, bent a little (BendLines), or round.
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/path/chord/scan_line.h"
#include "cam/path/parallel/line_frame.h"
#include "cam/toolpath/segment_tree.h"
#include "core/base/run_context.h"

namespace patchmill {

struct ZigzagParams : PassParams {
  double angle = 0.0;     // rad, direction of the lines in plan, from +x
  double max_bend = 0.0;  // rad, how far lines may turn from it to keep their steps even; 0: straight
  const OperationLimits* part = nullptr;  // lines only where the contact is wanted; null: everywhere
  const SurfaceMask* where = nullptr;     // and only where this has it
  std::optional<CircularLines> around;    // circles in place of lines at an angle, none bent
  const SegmentTree* beside = nullptr;    // passes that are there already, whose step circles keep from them
};

// Lines cover every contact of the part whose slope lies in the window, each clipped to the window dilated by
// half a step along the centre curve; lines end at a sheet's outer border and roll over rims and creases that
// are locally highest ([machining M12]), and end above and below upright walls of more than two flat steps
// unless the window reaches them. Local narrow spots get partial lines; what needs steps below
// min_step_fraction of the flat one gets those. Ordered by line, then along the line; every path runs in
// +angle direction, up to its bend (linking turns them). Round lines: from the innermost outwards,
// counter-clockwise, their places in plan within the chord tolerance of the circle; closed where all of one
// is wanted. Deterministic; parallel over lines.
absl::StatusOr<std::vector<CutterPath>> ZigzagPaths(const Locator& locator, const ZigzagParams& params,
                                                    const RunContext& run);

}  // namespace patchmill
