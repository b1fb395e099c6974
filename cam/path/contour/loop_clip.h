// Finds which parts of a contour are passes ([contours, section 6], [machining M12]).
#pragma once

#include <vector>

#include "cam/path/contour/contour_levels.h"
#include "cam/path/zlevel/level_trace.h"

namespace patchmill {

struct ClipParams {
  SlopeWindow window;
  bool roll = false;  // the ball rolls over every open edge, not only over rims that are locally highest
  // mm along the loop, added at both ends of what lies in the window. It is half a step: surface this near to
  // an edge is finished from the edge.
  double overlap = 0.0;
  // If not empty, only places within `near` (mm, in space) of one of these centres count.
  std::vector<Vec3> spots;
  double near = 0.0;
};

// Returns the parts of a contour (closed or not) whose contact has z <= c, is interior or lies on a crease or
// on an open rim that is locally highest, and whose slope lies in the window. They are dilated by the overlap
// where passes are allowed. A part that rolls over creases alone, with no face within half a step, is left
// out: the faces on both sides have passes of their own. Ends are solved on the contour to 1e-6 mm. A loop
// that stays whole stays closed.
std::vector<CutterPath> ClipLoop(const LevelContext& context, const CutterPath& loop,
                                 const ClipParams& params);

}  // namespace patchmill
