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
  double angle = 0.0;  // rad, direction of the lines in plan, from +x
  double max_bend =
      0.0;  // rad: lines may turn from that direction by so much, to keep their steps even; 0: straight
  const OperationLimits* part = nullptr;  // only contacts that it wants are cut; null: all
  const SurfaceMask* where = nullptr;     // and only contacts on it; null: all
  std::optional<CircularLines> around;    // circles instead of lines at an angle; they do not bend
  const SegmentTree* beside = nullptr;    // passes that exist already; circles keep a step away from them
};

// Returns lines that cover every contact of the part with a slope in the window. Each line is clipped to the
// window, extended by half a step along the line. Lines end at open edges of a sheet, but roll over rims and
// creases that are locally highest [machining M12]. Unless the window contains vertical faces, they end above
// and below vertical faces that are higher than two flat step-overs. Partial lines fill gaps that are too
// wide for the surface. No lines lie closer together than min_step_fraction of the flat step-over.
//
// Paths are ordered by line, then along the line. Each runs in the direction `angle`, apart from its bends;
// linking may turn it round. Circular lines come from the innermost outwards and run counter-clockwise. In
// plan they are within the chord tolerance of the circle. They are closed if the whole circle is wanted.
// Deterministic; parallel over lines.
absl::StatusOr<std::vector<CutterPath>> ZigzagPaths(const Locator& locator, const ZigzagParams& params,
                                                    const RunContext& run);

}  // namespace patchmill
