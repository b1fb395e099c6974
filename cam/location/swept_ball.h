// Distances to a straight move of the ball's centre with everything above it.
#pragma once

#include "core/base/vec.h"

namespace patchmill::internal {

// [location T2a]: a point at least sqrt(d0) from one end of a segment of this length and sqrt(d1) from
// the other is at least the square root of the returned value from all of it. Sharp. Proof: with its foot w
// from the first end (inside the segment) the squared distance is at least max(d0 - w^2, d1 - (length -
// w)^2), one falling, one rising in w: least where both are equal, or at an end; with the foot outside, an
// end is nearest.
double ChordDistance2(double d0, double d1, double length);

// The convex set K = {a + t (b - a) + s e_z : 0 <= t <= 1, s >= 0}.
class SweptBall {
 public:
  SweptBall(const Vec3& a, const Vec3& b) : a_(a), b_(b) {}
  Vec3 Nearest(const Vec3& p) const;  // point of K
  double Distance(const Vec3& p) const { return (p - Nearest(p)).norm(); }
  // A lower bound of the distance from K to the box |(x - center) . axis.col(k)| <= half[k], by separating
  // planes: square to the connection of the box's centre, and along its third axis. Second-order tight on
  // flat boxes.
  double DistanceBelow(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half) const;

 private:
  Vec3 a_, b_;
};

}  // namespace patchmill::internal
