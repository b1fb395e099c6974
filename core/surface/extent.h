// Exact extremes of a surface: its lowest and highest point, and its box.
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

}  // namespace patchmill
