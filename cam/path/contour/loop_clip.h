// Which part of a contour is a pass ([contours, section 6], [machining M12]).
#pragma once

#include <vector>

#include "cam/path/contour/contour_levels.h"
#include "cam/path/zlevel/level_trace.h"

namespace patchmill {

struct ClipParams {
  SlopeWindow window;
  bool roll = false;  // over every open border, not only over rims that are locally highest
  // mm along the loop, added at both ends of what lies in the window; half a step: ground this near an edge
  // is finished from it.
  double overlap = 0.0;
  // Not empty: only within `near` (mm, in space) of one of these centres.
  std::vector<Vec3> spots;
  double near = 0.0;
};

// The parts of a contour (closed or not) whose contact has z <= c, is interior or lies on a crease, or on an
// open rim that is locally highest, and whose slope lies in the window; dilated by the overlap where the
// ground allows it. What rolls over creases alone, no ground within half a step, is left out: the ground on
// both sides has passes of its own. Ends are solved on the contour to 1e-6 mm. A loop that stays whole stays
// closed.
std::vector<CutterPath> ClipLoop(const LevelContext& context, const CutterPath& loop,
                                 const ClipParams& params);

}  // namespace patchmill
