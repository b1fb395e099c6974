#include "cam/path/zlevel/level_slopes.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

struct Cone {
  Vec3 axis = Vec3::Zero();
  double angle = kPi;  // half angle; pi: no bound
};

// rad: acos of a cosine near 1 is exact to this.
constexpr double kAcosError = 3e-8;

// Returns the smallest cone about the mean direction that holds all vectors. Vectors that vanish have no
// direction. Normalises `vectors` in place.
Cone ConeOf(std::vector<Vec3>& vectors) {
  double longest = 0.0;
  for (const Vec3& v : vectors) longest = std::max(longest, v.squaredNorm());
  if (longest == 0.0) return {};
  const double tiny = 1e-24 * longest;
  Vec3 sum = Vec3::Zero();
  for (Vec3& v : vectors) {
    const double square = v.squaredNorm();
    v = square > tiny ? Vec3(v / std::sqrt(square)) : Vec3::Zero();
    sum += v;
  }
  if (sum.norm() < 1e-6) return {};
  const Vec3 axis = sum.normalized();
  double cosine = 1.0;
  for (const Vec3& v : vectors) {
    if (v != Vec3::Zero()) cosine = std::min(cosine, axis.dot(v));
  }
  return {axis, std::acos(std::max(-1.0, cosine)) + kAcosError};
}

double Binomial(int n, int k) {
  double b = 1.0;
  for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
  return b;
}

// Writes the control vectors of a positive multiple of S_u (or S_v) into `out`.
void Hodograph(const BernsteinNet& net, bool along_u, std::vector<Vec3>& out) {
  const int nu = net.degree_u, nv = net.degree_v, row = nv + 1;
  const int du = along_u ? nu - 1 : nu, dv = along_u ? nv : nv - 1;
  const auto at = [&](int i, int j) -> const Vec4& {
    return net.points[static_cast<std::size_t>(i * row + j)];
  };
  const auto difference = [&](int i, int j) -> Vec4 {
    return along_u ? Vec4(at(i + 1, j) - at(i, j)) : Vec4(at(i, j + 1) - at(i, j));
  };
  out.clear();
  if (!net.rational) {
    for (int i = 0; i <= du; ++i) {
      for (int j = 0; j <= dv; ++j) out.push_back(difference(i, j).head<3>());
    }
    return;
  }
  // This is a product of Bernstein forms. The binomials of the result's own degree are a positive factor per
  // coefficient and do not change its direction.
  const int rows = nu + du + 1, columns = nv + dv + 1;
  out.assign(static_cast<std::size_t>(rows * columns), Vec3::Zero());
  thread_local std::vector<Vec4> scaled;
  scaled.clear();
  for (int k = 0; k <= nu; ++k) {
    for (int l = 0; l <= nv; ++l) scaled.push_back(Binomial(nu, k) * Binomial(nv, l) * at(k, l));
  }
  for (int i = 0; i <= du; ++i) {
    for (int j = 0; j <= dv; ++j) {
      const Vec4 d = Binomial(du, i) * Binomial(dv, j) * difference(i, j);
      for (int k = 0; k <= nu; ++k) {
        Vec3* to = &out[static_cast<std::size_t>((i + k) * columns + j)];
        const Vec4* from = &scaled[static_cast<std::size_t>(k * row)];
        for (int l = 0; l <= nv; ++l) to[l] += d.head<3>() * from[l].w() - from[l].head<3>() * d.w();
      }
    }
  }
}

}  // namespace

NormalCone BoundNormals(const BernsteinNet& net) {
  if (net.degree_u < 1 || net.degree_v < 1) return {};
  thread_local std::vector<Vec3> vectors;
  Hodograph(net, true, vectors);
  const Cone u = ConeOf(vectors);
  Hodograph(net, false, vectors);
  const Cone v = ConeOf(vectors);
  if (u.angle + v.angle >= kPi / 2.0) return {};
  const Vec3 normal = u.axis.cross(v.axis);
  const double between = std::atan2(normal.norm(), u.axis.dot(v.axis));
  if (between <= u.angle + v.angle || kPi - between <= u.angle + v.angle) return {};
  const double su = std::sin(u.angle), sv = std::sin(v.angle), sb = std::sin(between);
  const double s = std::sqrt(su * su + 2.0 * su * sv * std::abs(std::cos(between)) + sv * sv) / sb;
  if (!(s < 1.0)) return {};
  return {normal.normalized(), std::asin(s)};
}

SlopeRange SlopesOf(const NormalCone& normals) {
  if (normals.angle >= kPi / 2.0) return {};
  const Vec3& n = normals.axis;
  const double slope = std::atan2(std::hypot(n.x(), n.y()), std::abs(n.z()));
  return {std::max(0.0, slope - normals.angle), std::min(kPi / 2.0, slope + normals.angle)};
}

}  // namespace patchmill
