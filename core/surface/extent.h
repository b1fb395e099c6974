// Exact extremes of a surface: its lowest and highest point. Also an estimate of its smallest concave radius.
#pragma once

#include "core/surface/surface.h"

namespace patchmill {

// The lowest point of the surface, exact to `tolerance` (mm). Found by branch and bound on the Bernstein
// nets. The returned height is that of a true surface point: never below the minimum, and at most `tolerance`
// above it. These three functions stop early if the run of their thread is cancelled (polled_run.h); the
// result has no meaning then.
SurfacePoint LowestPoint(const Surface& surface, double tolerance = 1e-7);
// The same for the highest point.
SurfacePoint HighestPoint(const Surface& surface, double tolerance = 1e-7);
// The box of the surface itself, each side exact to `tolerance` and never too large. (Surface::box is the box
// of the leaf bounds.)
Box3 TightBox(const Surface& surface, double tolerance = 1e-7);

struct ConcaveSpot {
  double radius =
      kInfinity;  // mm, 1 / largest normal curvature towards the upward normal; infinity: nowhere concave
  SurfacePoint at;
};
// The smallest concave radius over all points whose upward normal is not horizontal (e_z > 1e-6). It is found
// by sampling every leaf and refining the best places by a pattern search. It is an estimate from above, not
// a bound, because the curvature may peak between samples.
ConcaveSpot SmallestConcaveRadius(const Surface& surface, const RunContext& run);

}  // namespace patchmill
