// Zig-zag passes over gentle areas: scan lines side by side, spaced for the scallop by the centre formula.
// They are straight, bent a little (BendLines), or circular.
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

struct ZigzagParams {
  PassParams pass;
  double angle = 0.0;     // rad, direction of the lines in plan, from +x
  double max_bend = 0.0;  // rad, how far lines may turn from it to keep their steps even; 0: straight
  const OperationLimits* part = nullptr;  // lines run only where it wants the contact; null: everywhere
  const SurfaceMask* where = nullptr;     // and only where it holds the contact; null: everywhere
  std::optional<CircularLines> around;    // circles instead of lines at an angle; they do not bend
  const SegmentTree* beside = nullptr;    // passes that exist already; circles keep a step away from them
};

// Lines cover every contact of the part whose slope lies in the window. Each is clipped to the window dilated
// by half a step along the centre curve. Lines end at open edges of a sheet, roll over rims and creases that
// are locally highest ([machining M12]), and end above and below vertical faces of more than two flat
// step-overs unless the window reaches these. Narrow spots get partial lines. Where less than
// min_step_fraction of the flat step-over is needed, lines keep that fraction. Paths are ordered by line,
// then along the line; each runs in +angle direction, up to its bend (linking turns them). Circular lines run
// from the innermost outwards, counter-clockwise. Their places in plan are within the chord tolerance of the
// circle, and they are closed where all of a circle is wanted. Deterministic; parallel over lines.
absl::StatusOr<std::vector<CutterPath>> ZigzagPaths(const Locator& locator, const ZigzagParams& params,
                                                    const RunContext& run);

}  // namespace patchmill
