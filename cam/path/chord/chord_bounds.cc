#include "cam/path/chord/chord_bounds.h"

#include <algorithm>
#include <cmath>

#include "cam/location/swept_ball.h"

namespace patchmill {
namespace {

// Returns where along the chord (0..1) both supports are equally far. Any value is a valid split, this one is
// the best.
double BestSplit(double radius, const Vec3& a, const Vec3& b, const Support& at_a, const Support& at_b) {
  if (at_a.contact && at_b.contact) {
    // |x - p|^2 - |x - q|^2 is linear in x.
    const Vec3 pq = *at_a.contact - *at_b.contact;
    const double rise = -2.0 * (b - a).dot(pq);
    const double at0 = (a - *at_a.contact).squaredNorm() - (a - *at_b.contact).squaredNorm();
    // One support is nearer all along: it serves the whole chord.
    if (at0 <= 0.0 && at0 + rise <= 0.0) return 1.0;
    if (at0 >= 0.0 && at0 + rise >= 0.0) return 0.0;
    return std::clamp(-at0 / rise, 0.0, 1.0);
  }
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double mid = 0.5 * (low + high);
    const Vec3 x = a + mid * (b - a);
    (at_a.Clearance(x, radius) < at_b.Clearance(x, radius) ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

}  // namespace

double ChordGouge(double radius, double length) {
  if (length >= 2.0 * radius) return radius;
  const double quarter = 0.25 * length * length;
  return quarter / (radius + std::sqrt(radius * radius - quarter));
}

double ChordGouge(double radius, const Vec3& a, const Vec3& b, std::span<const Vec3> free) {
  const Vec3 move = b - a;
  const double length = move.norm();
  if (!(length > 0.0)) return 0.0;
  double t0 = 0.0, d0 = radius * radius, least = d0;
  for (std::size_t k = 1; k < free.size(); ++k) {
    double t = 1.0, distance = 0.0;
    if (k + 1 < free.size()) {
      // Take the place straight above the centre if the move passes there, else the foot of the
      // perpendicular.
      const Vec3& c = free[k];
      t = (c - a).dot(move) / (length * length);
      const double plan2 = Xy(move).squaredNorm();
      if (plan2 > 0.0) {
        const double over = Xy(Vec3(c - a)).dot(Xy(move)) / plan2;
        if (a.z() + over * move.z() >= c.z()) t = over;
      }
      t = std::clamp(t, t0, 1.0);
      Vec3 off = a + t * move - c;
      off.z() = std::min(off.z(), 0.0);
      distance = off.norm();
    }
    if (distance >= radius) return radius;
    const double d1 = (radius - distance) * (radius - distance);
    least = std::min(least, t > t0 ? internal::ChordDistance2(d0, d1, (t - t0) * length) : std::min(d0, d1));
    t0 = t;
    d0 = d1;
  }
  return least > 0.0 ? radius - std::sqrt(least) : radius;
}

double LongestChord(double radius, double tolerance) {
  const double t = std::clamp(tolerance, 0.0, radius);
  return 2.0 * std::sqrt(t * (2.0 * radius - t));
}

double ChordExcess(double radius, const Vec3& a, const Vec3& b, const Support& at_a, const Support& at_b) {
  const double split = BestSplit(radius, a, b, at_a, at_b);
  const Vec3 x = a + split * (b - a);
  return std::max({at_a.Clearance(a, radius), at_a.Clearance(x, radius), at_b.Clearance(x, radius),
                   at_b.Clearance(b, radius)});
}

}  // namespace patchmill
