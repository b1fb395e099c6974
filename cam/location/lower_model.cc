// What a leaf's model proves for one centre.
#include <cmath>

#include "cam/location/leaf_model.h"

namespace patchmill::internal {
namespace {

constexpr Box2 kUnit{-0.5, 0.5, -0.5, 0.5};

}  // namespace

LowerModel BoundBelow(const LeafModel& m, const Vec3& c) {
  LowerModel low;
  const Vec3 d = m.s - c;
  const double distance2 = d.squaredNorm();
  const double size = std::sqrt(distance2) + m.reach, drift_a = m.drift_a, drift_b = m.drift_b;
  const double e_uu = m.gram_uu + size * m.drift_uu, e_uv = m.gram_uv + size * m.drift_uv,
               e_vv = m.gram_vv + size * m.drift_vv;
  low.f0 = 0.5 * distance2 - m.rest * size;
  low.q.a = m.a.squaredNorm() + d.dot(m.uu) - e_uu - e_uv;
  low.q.b = m.a.dot(m.b) + d.dot(m.uv);
  low.q.c = m.b.squaredNorm() + d.dot(m.vv) - e_vv - e_uv;
  low.q.gx = d.dot(m.a);
  low.q.gy = d.dot(m.b);
  low.convex = low.q.a > 0.0 && low.q.c > 0.0 && low.q.a * low.q.c > low.q.b * low.q.b;
  low.minorant = m.z_max <= c.z();
  if (low.minorant || !low.convex) return low;

  // The part above c is measured horizontally: there the Hessian lacks z_i z_j + (z - c_z) z_ij. f is once
  // differentiable across the level of c, so it is convex when both Hessians are positive definite.
  const double az = std::abs(m.a.z()), bz = std::abs(m.b.z());
  const double rise = std::abs(d.z()) + m.reach;
  const double h_uu =
      e_uu + 2.0 * az * drift_a + drift_a * drift_a + rise * m.drift_uu + m.reach * std::abs(m.uu.z());
  const double h_vv =
      e_vv + 2.0 * bz * drift_b + drift_b * drift_b + rise * m.drift_vv + m.reach * std::abs(m.vv.z());
  const double h_uv = e_uv + az * drift_b + bz * drift_a + drift_a * drift_b + rise * m.drift_uv +
                      m.reach * std::abs(m.uv.z());
  const double a = m.a.head<2>().squaredNorm() + d.head<2>().dot(m.uu.head<2>()) - h_uu - h_uv;
  const double b = m.a.head<2>().dot(m.b.head<2>()) + d.head<2>().dot(m.uv.head<2>());
  const double cc = m.b.head<2>().squaredNorm() + d.head<2>().dot(m.vv.head<2>()) - h_vv - h_uv;
  low.convex = a > 0.0 && cc > 0.0 && a * cc > b * b;
  return low;
}

BoxMinimum GuessMinimum(const LeafModel& m, const Vec3& c) {
  Vec3 d = m.s - c;
  if (d.z() > 0.0) d.z() = 0.0;  // above c only the horizontal distance counts
  Quadratic2 q;
  const double aa = m.a.squaredNorm(), bb = m.b.squaredNorm(), ab = m.a.dot(m.b);
  q.a = aa + d.dot(m.uu);
  q.b = ab + d.dot(m.uv);
  q.c = bb + d.dot(m.vv);
  q.gx = d.dot(m.a);
  q.gy = d.dot(m.b);
  if (!(q.a > 0.0 && q.c > 0.0 && q.a * q.c > 1.0001 * q.b * q.b)) {
    q.a = aa;
    q.b = ab;
    q.c = bb;
    if (!(aa > 0.0 && bb > 0.0 && aa * bb > 1.0001 * ab * ab)) return {0.0, 0.0, 0.0};
  }
  return MinimizeOnBox(q, kUnit);
}

}  // namespace patchmill::internal
