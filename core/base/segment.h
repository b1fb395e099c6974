// Distances of points to segments.
#pragma once

#include <algorithm>

#include "core/base/vec.h"

namespace patchmill {

// Parameter in [0,1] of the point of the segment a b nearest to p; 0 when a == b.
inline double SegmentFoot(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double l2 = ab.squaredNorm();
  return l2 > 0.0 ? std::clamp((p - a).dot(ab) / l2, 0.0, 1.0) : 0.0;
}

// Distance of p to the segment a b. Error a few ulps of the coordinates.
inline double SegmentDistance(const Vec3& p, const Vec3& a, const Vec3& b) {
  return (p - (a + SegmentFoot(p, a, b) * (b - a))).norm();
}

}  // namespace patchmill
