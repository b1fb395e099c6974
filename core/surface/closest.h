// Closest surface point to simple sets; what the independent verifier stands on (no code of cam/location).
#pragma once

#include <optional>

#include "core/surface/surface.h"

namespace patchmill {

struct ClosestPoint {
  SurfacePoint at;
  double distance = 0.0;  // mm; within `tolerance` of the true minimum, never below it by more than that
};

// Nearest point of the surface to the upward vertical ray {c + s e_z, s >= 0}, if nearer than `limit`. Branch
// and bound over the leaves with Newton inside; the answer's distance is within `tolerance` (mm) of the true
// minimum.
std::optional<ClosestPoint> ClosestToUpwardRay(const Surface& surface, const Vec3& c, double limit,
                                               double tolerance);
// Nearest point of the surface to the point c, if nearer than `limit`.
std::optional<ClosestPoint> ClosestToPoint(const Surface& surface, const Vec3& c, double limit,
                                           double tolerance);

}  // namespace patchmill
