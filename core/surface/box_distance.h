// Distance of boxes to a point or to the upward ray {c + s e_z, s >= 0}. Squared, exact up to rounding.
#pragma once

#include <algorithm>

#include "core/base/vec.h"

namespace patchmill {

enum class Reach { kPoint, kUpwardRay };

// Vector from the set at the origin to p: of a point p itself, of the ray without what lies above 0.
template <Reach kReach>
inline Vec3 FromSet(const Vec3& p) {
  return kReach == Reach::kUpwardRay && p.z() > 0.0 ? Vec3(p.x(), p.y(), 0.0) : p;
}

template <Reach kReach>
inline double SquaredDistance(const Box3& box, const Vec3& c) {
  const double x = std::max({box.min.x() - c.x(), c.x() - box.max.x(), 0.0});
  const double y = std::max({box.min.y() - c.y(), c.y() - box.max.y(), 0.0});
  const double above = kReach == Reach::kUpwardRay ? 0.0 : box.min.z() - c.z();
  const double z = std::max({above, c.z() - box.max.z(), 0.0});
  return x * x + y * y + z * z;
}

// Oriented box: center, orthonormal axes (columns), half sides. The point c.
double SquaredDistanceToPoint(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                              const Vec3& c);
// The same to the ray: the minimum over s of a convex piecewise quadratic, found between its break points.
double SquaredDistanceToUpwardRay(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                                  const Vec3& c);

}  // namespace patchmill
