// Exact extremes of a surface: its lowest and highest point, its tightest concave spot.
#pragma once

#include "core/surface/surface.h"

namespace patchmill {

// Lowest point of the surface, right to `tolerance` (mm): branch and bound on the Bernstein nets. The
// returned height is that of a true surface point, so never below the minimum and above it by at most
// `tolerance`.
SurfacePoint LowestPoint(const Surface& surface, double tolerance = 1e-7);
// The same for the highest one.
SurfacePoint HighestPoint(const Surface& surface, double tolerance = 1e-7);
// Box of the surface itself (Surface::box is that of its bounds), each side right to `tolerance`, never
// larger.
Box3 TightBox(const Surface& surface, double tolerance = 1e-7);

struct ConcaveSpot {
  double radius =
      kInfinity;  // mm, 1 / largest normal curvature towards the upward normal; infinity: nowhere concave
  SurfacePoint at;
};
// Smallest concave radius over all points whose upward normal is not horizontal (e_z > 1e-6). Found by
// sampling every leaf and refining the best spots by a pattern search; an estimate from above, no bound:
// curvature may peak between samples.
ConcaveSpot SmallestConcaveRadius(const Surface& surface, const RunContext& run);

}  // namespace patchmill
