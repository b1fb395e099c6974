// Closest surface point to simple sets; what the independent verifier stands on (no code of cam/location).
#pragma once

#include <optional>

#include "core/surface/surface.h"

namespace patchmill {

struct ClosestPoint {
  SurfacePoint at;
  double distance = 0.0;  // mm, of the surface point `at`: at most `tolerance` above the true minimum
};

// Nearest point of the surface to the upward vertical ray {c + s e_z, s >= 0}, if nearer than `limit` (mm,
// may be infinite). nullopt proves that nothing is nearer than limit - tolerance. Every kind of patch, open
// edges and degenerate places included.
//
// Branch and bound over the leaves: their boxes, then the polynomial of the squared distance over the leaf
// (core/surface/distance_form.h), halved until proven. `tolerance` (mm) is raised to 1e-12 of the largest
// coordinate, which is the rounding slack. A tight `limit` is the best help: leaves beyond it are not opened.
// Thread-safe.
std::optional<ClosestPoint> ClosestToUpwardRay(const Surface& surface, const Vec3& c, double limit,
                                               double tolerance);
// What is above c: as ClosestToUpwardRay, but only of the leaves that reach above it. nullopt proves that
// nothing above c is nearer to the ray than limit - tolerance; a point found that is not above c, that
// nothing above is nearer than this point, up to the tolerance.
std::optional<ClosestPoint> ClosestAbove(const Surface& surface, const Vec3& c, double limit,
                                         double tolerance);
// Nearest point of the surface to the point c, if nearer than `limit`; otherwise as above.
std::optional<ClosestPoint> ClosestToPoint(const Surface& surface, const Vec3& c, double limit,
                                           double tolerance);
// Some point of the surface nearer than `limit` to the point c (the first one found, not the nearest): much
// cheaper. nullopt proves that nothing is nearer than limit - tolerance.
std::optional<ClosestPoint> FirstNearPoint(const Surface& surface, const Vec3& c, double limit,
                                           double tolerance);

// Whether some point of the surface is nearer than `limit` to the upward ray: true with such a point found
// (the first one, not the nearest), false proves that nothing is nearer than limit - tolerance.
bool AnythingNearUpwardRay(const Surface& surface, const Vec3& c, double limit, double tolerance);
// The same, with the point.
std::optional<ClosestPoint> FirstNearUpwardRay(const Surface& surface, const Vec3& c, double limit,
                                               double tolerance);
// Whether anything above c may be nearer than `limit` to the upward ray, as far as boxes tell: false proves
// that nothing is. Below a microsecond.
bool MayRiseAbove(const Surface& surface, const Vec3& c, double limit);

}  // namespace patchmill
