// Distances to a straight move of the ball's centre, with everything above it.
#pragma once

#include "core/base/vec.h"

namespace patchmill::internal {

// [location T2a]: if a point is at least sqrt(d0) from one end of a segment of this length and sqrt(d1) from
// the other, it is at least the square root of the returned value from all of it. Sharp. Proof: let the foot
// of the point lie at w from the first end, inside the segment. The squared distance is at least
// max(d0 - w^2, d1 - (length - w)^2). One term falls and the other rises in w, so the smallest value is where
// both are equal, or at an end. If the foot lies outside, an end is nearest.
double ChordDistance2(double d0, double d1, double length);

// The convex set K = {a + t (b - a) + s e_z : 0 <= t <= 1, s >= 0}.
class SweptBall {
 public:
  SweptBall(const Vec3& a, const Vec3& b) : a_(a), b_(b) {}
  Vec3 Nearest(const Vec3& p) const;  // the nearest point of K
  double Distance(const Vec3& p) const { return (p - Nearest(p)).norm(); }
  // A lower bound of the distance from K to the box |(x - center) . axis.col(k)| <= half[k]. Two separating
  // planes are tried: one at right angles to the connection of the box's centre with K, one at right angles
  // to the box's third axis. It is tight to second order for flat boxes.
  double DistanceBelow(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half) const;

 private:
  Vec3 a_, b_;
};

}  // namespace patchmill::internal
