// Distances from surface points and boxes to the upward ray {c + s e_z, s >= 0} of a centre c. A point is in
// the way of ball or upward sweep iff its distance from the ray is less than R ([location T1]).
#pragma once

#include <algorithm>
#include <cmath>

#include "core/surface/surface.h"

namespace patchmill::internal {

// The vector from p to the nearest point of the ray.
inline Vec3 ToRay(const Vec3& p, const Vec3& c) {
  return {c.x() - p.x(), c.y() - p.y(), std::max(0.0, c.z() - p.z())};
}

inline double XyDistance2(const Box3& box, const Vec2& q) {
  const double dx = std::max({box.min.x() - q.x(), q.x() - box.max.x(), 0.0});
  const double dy = std::max({box.min.y() - q.y(), q.y() - box.max.y(), 0.0});
  return dx * dx + dy * dy;
}

// True if the box is at least sqrt(limit2) away from the ray.
inline bool BoxOutside(const Box3& box, const Vec3& c, double limit2) {
  const double dz = std::max(0.0, c.z() - box.max.z());
  return XyDistance2(box, Xy(c)) + dz * dz >= limit2;
}

// The same for an oriented box |(x - center) . axis.col(k)| <= half[k]. Proof: consider the plane through the
// box point nearest to c, at right angles to the shortest connection. It separates the box from c by the
// distance. If it does not rise towards the box, it separates the box from the whole ray. Otherwise its
// horizontal part is tried.
inline bool OrientedBoxOutside(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                               const Vec3& c, double limit2) {
  const Vec3 m = c - center;
  Vec3 out = Vec3::Zero();  // from the nearest box point to c
  double distance2 = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double y = axis.col(k).dot(m);
    const double e = std::abs(y) - half[k];
    if (e > 0.0) {
      distance2 += e * e;
      out += std::copysign(e, y) * axis.col(k);
    }
  }
  if (distance2 < limit2) return false;
  if (out.z() >= 0.0) return true;
  const double length2 = out.x() * out.x() + out.y() * out.y();
  if (!(length2 > 0.0)) return false;
  double gap = out.x() * m.x() + out.y() * m.y();
  for (int k = 0; k < 3; ++k) gap -= half[k] * std::abs(out.x() * axis(0, k) + out.y() * axis(1, k));
  return gap > 0.0 && gap * gap >= limit2 * length2;
}

// A lower bound of the squared distance of the same oriented box, by the same planes.
inline double OrientedBoxDistance2(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                                   const Vec3& c) {
  const Vec3 m = c - center;
  Vec3 out = Vec3::Zero();
  double distance2 = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double y = axis.col(k).dot(m);
    const double e = std::abs(y) - half[k];
    if (e > 0.0) {
      distance2 += e * e;
      out += std::copysign(e, y) * axis.col(k);
    }
  }
  if (out.z() >= 0.0) return distance2;
  const double length2 = out.x() * out.x() + out.y() * out.y();
  if (!(length2 > 0.0)) return 0.0;
  double gap = out.x() * m.x() + out.y() * m.y();
  for (int k = 0; k < 3; ++k) gap -= half[k] * std::abs(out.x() * axis(0, k) + out.y() * axis(1, k));
  return gap > 0.0 ? gap * gap / length2 : 0.0;
}

}  // namespace patchmill::internal
