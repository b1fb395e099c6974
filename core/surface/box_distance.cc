#include "core/surface/box_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace patchmill {
namespace {

// phi(s) = sum_k max(0, |a_k + s b_k| - h_k)^2
struct GapAlongRay {
  Vec3 a, b, h;

  double Gap(int k, double s) const {  // signed: the sign tells the side of the slab
    const double x = a[k] + s * b[k];
    return x > h[k] ? x - h[k] : x < -h[k] ? x + h[k] : 0.0;
  }
  double Value(double s) const {
    const double x = Gap(0, s), y = Gap(1, s), z = Gap(2, s);
    return x * x + y * y + z * z;
  }
  double HalfSlope(double s) const { return Gap(0, s) * b[0] + Gap(1, s) * b[1] + Gap(2, s) * b[2]; }
};

}  // namespace

double SquaredDistanceToPoint(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                              const Vec3& c) {
  const Vec3 d = c - center;
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max(0.0, std::abs(axis.col(k).dot(d)) - half[k]);
    sum += gap * gap;
  }
  return sum;
}

double SquaredDistanceToUpwardRay(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                                  const Vec3& c) {
  const Vec3 d = c - center;
  const GapAlongRay gap{Vec3(axis.col(0).dot(d), axis.col(1).dot(d), axis.col(2).dot(d)),
                        Vec3(axis(2, 0), axis(2, 1), axis(2, 2)), half};
  double slope0 = gap.HalfSlope(0.0), s0 = 0.0;
  if (slope0 >= 0.0) return gap.Value(0.0);
  std::array<double, 6> breaks;
  std::size_t count = 0;
  for (int k = 0; k < 3; ++k) {
    if (gap.b[k] == 0.0) continue;
    for (const double side : {-gap.h[k], gap.h[k]}) {
      const double s = (side - gap.a[k]) / gap.b[k];
      if (s > 0.0 && std::isfinite(s)) breaks[count++] = s;
    }
  }
  std::sort(breaks.begin(), breaks.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const double s1 = breaks[i], slope1 = gap.HalfSlope(s1);
    if (slope1 >= 0.0) {  // the slope is linear between the break points
      const double t = slope1 > slope0 ? -slope0 / (slope1 - slope0) : 1.0;
      return gap.Value(s0 + t * (s1 - s0));
    }
    s0 = s1;
    slope0 = slope1;
  }
  // Beyond the last break point the ray has left every slab. There the derivative of the slope is |b|^2 = 1.
  return gap.Value(s0 - slope0 / gap.b.squaredNorm());
}

}  // namespace patchmill
