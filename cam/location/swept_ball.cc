#include "cam/location/swept_ball.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patchmill::internal {
namespace {

Vec2 NearestOnSegment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return a + t * d;
}

}  // namespace

double ChordDistance2(double d0, double d1, double length) {
  const double least = std::min(d0, d1);
  const double w = 0.5 * (d0 - d1 + length * length) / length;
  return w > 0.0 && w < length ? std::min(least, d0 - w * w) : least;
}

Vec3 SweptBall::Nearest(const Vec3& p) const {
  const Vec2 e = Xy(b_) - Xy(a_);
  const double length = e.norm();
  if (!(length > 0.0)) return {a_.x(), a_.y(), std::max(p.z(), std::min(a_.z(), b_.z()))};
  // Coordinates in the vertical plane through the move: x along it, z up. K is everything above the segment.
  const double x = (Xy(p) - Xy(a_)).dot(e) / length;
  const Vec2 in_plane(x, p.z());
  const Vec2 a(0.0, a_.z()), b(length, b_.z());
  Vec2 best;
  if (x >= 0.0 && x <= length && p.z() >= a.y() + (b.y() - a.y()) * (x / length)) {
    best = in_plane;
  } else {
    const std::array<Vec2, 3> candidates = {NearestOnSegment(in_plane, a, b),
                                            Vec2(0.0, std::max(p.z(), a.y())),
                                            Vec2(length, std::max(p.z(), b.y()))};
    best = *std::min_element(candidates.begin(), candidates.end(), [&](const Vec2& s, const Vec2& t) {
      return (s - in_plane).squaredNorm() < (t - in_plane).squaredNorm();
    });
  }
  return Lift(Xy(a_) + (best.x() / length) * e, best.y());
}

double SweptBall::DistanceBelow(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half) const {
  // For a unit d with d_z <= 0 the farthest point of K along d is a or b.
  const auto separation = [&](const Vec3& d) {
    double gap = d.dot(center) - std::max(d.dot(a_), d.dot(b_));
    for (int k = 0; k < 3; ++k) gap -= half[k] * std::abs(d.dot(axis.col(k)));
    return gap;
  };
  double below = 0.0;
  const Vec3 away = center - Nearest(center);
  const double distance = away.norm();
  if (distance > 0.0) below = std::max(below, separation(away / distance));
  Vec3 normal = axis.col(2);
  if (normal.z() > 0.0) normal = -normal;
  below = std::max(below, separation(normal));
  return below;
}

}  // namespace patchmill::internal
