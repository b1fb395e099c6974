// Finds which parts of the loop of a waterline are passes ([contours, section 6], [machining M12]).
#pragma once

#include <vector>

#include "cam/path/contour/contour_levels.h"
#include "cam/path/zlevel/level_trace.h"

namespace patchmill {

struct ClipParams {
  SlopeWindow window;
  // Edge rule ROLL: the ball rolls over every open edge. False: only over rims, open edges that are locally
  // highest.
  bool roll = false;
  // mm, half the step between passes. Each stretch in the window is extended along the loop by this much at
  // both ends, so that no ridge stays between it and the passes of the neighbouring area. A pass that rolls
  // over an edge finishes the faces beside the edge up to this far.
  double overlap = 0.0;
  // For partial levels: if not empty, a place is wanted only within `near` (mm, in space) of one of these
  // centres.
  std::vector<Vec3> spots;
  double near = 0.0;
};

// Returns the parts of a loop (closed or open, at the centre height c) that are passes. A place of the loop
// belongs to a pass if its contact fulfils three conditions:
// - it lies no higher than c, or is on a wall that goes straight down to c below the contact;
// - it is interior to a face, or on a crease, or on an open edge over which the ball may roll (`roll`);
// - its slope lies in the window.
//
// The parts are extended by the overlap as far as the first two conditions hold. A part that only rolls over
// creases, without a face within the overlap of it, is left out: the faces on both sides have passes of their
// own. Ends are solved on the loop to 1e-6 mm. A loop that stays whole stays closed.
std::vector<CutterPath> ClipLoop(const LevelContext& context, const CutterPath& loop,
                                 const ClipParams& params);

}  // namespace patchmill
