// Closest surface point to simple sets. The verifier is built on it; it uses no code of cam/location.
#pragma once

#include <optional>

#include "core/surface/surface.h"

namespace patchmill {

struct ClosestPoint {
  SurfacePoint at;
  double distance = 0.0;  // mm, to the surface point `at`; at most `tolerance` above the minimum
};

// The surface point nearest to the upward vertical ray {c + s e_z, s >= 0}, if it is nearer than `limit` (mm,
// may be infinite). nullopt proves that nothing is nearer than limit - tolerance. Covers every kind of patch,
// open edges and degenerate places.
//
// Branch and bound over the leaves. It uses their boxes first, then the polynomial of the squared distance
// over the leaf (core/surface/distance_form.h), halved until the answer is proven. `tolerance` (mm) is raised
// to 1e-12 of the largest coordinate, which is the rounding slack. A tight `limit` saves the most time,
// because leaves beyond it are not opened. Thread-safe.
std::optional<ClosestPoint> ClosestToUpwardRay(const Surface& surface, const Vec3& c, double limit,
                                               double tolerance);
// As ClosestToUpwardRay, but searches only the leaves that reach above c. nullopt proves that no point above
// c is nearer to the ray than limit - tolerance. The point found may lie below c. It then proves that no
// point above c is nearer than this one, up to the tolerance.
std::optional<ClosestPoint> ClosestAbove(const Surface& surface, const Vec3& c, double limit,
                                         double tolerance);
// The surface point nearest to the point c, if it is nearer than `limit`. Otherwise as ClosestToUpwardRay.
std::optional<ClosestPoint> ClosestToPoint(const Surface& surface, const Vec3& c, double limit,
                                           double tolerance);
// Some surface point nearer than `limit` to the point c: the first one found, not the nearest. This is much
// cheaper. nullopt proves that nothing is nearer than limit - tolerance.
std::optional<ClosestPoint> FirstNearPoint(const Surface& surface, const Vec3& c, double limit,
                                           double tolerance);

// Whether some surface point is nearer than `limit` to the upward ray. True: such a point was found (the
// first one, not the nearest). False proves that nothing is nearer than limit - tolerance.
bool AnythingNearUpwardRay(const Surface& surface, const Vec3& c, double limit, double tolerance);
// The same, but returns the point.
std::optional<ClosestPoint> FirstNearUpwardRay(const Surface& surface, const Vec3& c, double limit,
                                               double tolerance);
// Whether anything above c may be nearer than `limit` to the upward ray, judged by boxes alone. False proves
// that nothing is. Cost below a microsecond.
bool MayRiseAbove(const Surface& surface, const Vec3& c, double limit);

}  // namespace patchmill
