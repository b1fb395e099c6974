// The proofs that a leaf's model gives for one centre.
#include <algorithm>
#include <cmath>

#include "cam/location/leaf_model.h"

namespace patchmill::internal {
namespace {

constexpr Box2 kUnit{-0.5, 0.5, -0.5, 0.5};

// Whether half the squared distance in plan from c is convex on the rectangle, by the errors of its
// projection.
bool IsConvexInPlan(const LeafModel& m, const LeafErrors& errors, const Vec3& c) {
  const Vec2 a = Xy(m.a), b = Xy(m.b), d = Xy(m.s) - Xy(c);
  const double size = d.norm() + errors.reach;
  const double uu = a.squaredNorm() + d.dot(Xy(m.uu)) - errors.gram_uu - size * errors.drift_uu;
  const double vv = b.squaredNorm() + d.dot(Xy(m.vv)) - errors.gram_vv - size * errors.drift_vv;
  const double uv = std::abs(a.dot(b) + d.dot(Xy(m.uv))) + errors.gram_uv + size * errors.drift_uv;
  return uu > 0.0 && vv > 0.0 && uu * vv > uv * uv;
}

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

  if (m.plan && IsConvexInPlan(m, *m.plan, c)) return low;
  // The part above c is measured horizontally. There the Hessian lacks z_i z_j + (z - c_z) z_ij. f is once
  // differentiable across the level of c, so it is convex if both Hessians are positive definite.
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

// Let d = (s_xy - c_xy, -t), the gradient of the bound at s in space. Products in plan are those in space
// without their z parts:
//   S_u.S_u of the plan >= a.a of the plan + 2 (S_u - a).a - 2 (S_u - a)_z a_z,
//   (S - s).S_uu of the plan = (S - s).uu - (S - s)_z uu_z + (S - s).(S_uu - uu) of the plan,
//   d.S_uu = d.uu + d.(S_uu - uu).
// Here gram_uu bounds 2 (S_u - a).a + (S - s).uu from below. The mixed entry is alike.
LowerModel BoundBelowAtDepth(const LeafModel& m, const Vec3& c, double depth) {
  LowerModel low;
  low.minorant = true;
  const Vec3 d(m.s.x() - c.x(), m.s.y() - c.y(), -depth);
  const double size = d.norm() + m.reach, drift_a = m.drift_a, drift_b = m.drift_b;
  const double az = std::abs(m.a.z()), bz = std::abs(m.b.z());
  const double e_uu = m.gram_uu + 2.0 * az * drift_a + m.reach * std::abs(m.uu.z()) + size * m.drift_uu;
  const double e_vv = m.gram_vv + 2.0 * bz * drift_b + m.reach * std::abs(m.vv.z()) + size * m.drift_vv;
  const double e_uv =
      m.gram_uv + az * drift_b + bz * drift_a + m.reach * std::abs(m.uv.z()) + size * m.drift_uv;
  low.f0 = 0.5 * (d.x() * d.x() + d.y() * d.y() - depth * depth) + depth * (c.z() - m.s.z()) - m.rest * size;
  low.q.a = m.a.head<2>().squaredNorm() + d.dot(m.uu) - e_uu - e_uv;
  low.q.b = m.a.head<2>().dot(m.b.head<2>()) + d.dot(m.uv);
  low.q.c = m.b.head<2>().squaredNorm() + d.dot(m.vv) - e_vv - e_uv;
  low.q.gx = d.dot(m.a);
  low.q.gy = d.dot(m.b);
  return low;
}

double LeastOn(const LeafModel& m, const LowerModel& low, const Vec3& c) {
  if (low.minorant) return low.f0 + MinimizeOnBox(low.q, kUnit).value;
  const BoxMinimum at = GuessMinimum(m, c);
  const double z = m.s.z() + at.x * (m.a.z() + 0.5 * at.x * m.uu.z() + at.y * m.uv.z()) +
                   at.y * (m.b.z() + 0.5 * at.y * m.vv.z());
  const LowerModel beside = BoundBelowAtDepth(m, c, std::max(0.0, c.z() - z));
  return beside.f0 + MinimizeOnBox(beside.q, kUnit).value;
}

double LeastFrom(const LeafModel& m, const LowerModel& low, const Vec3& c, const LocalJet& at,
                 const Box2& part) {
  Quadratic2 q = low.minorant ? low.q : BoundBelowAtDepth(m, c, at.depth).q;
  q.gx = at.gradient.x();
  q.gy = at.gradient.y();
  return at.f + MinimizeOnBox(q, {part.x0 - at.x, part.x1 - at.x, part.y0 - at.y, part.y1 - at.y}).value;
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
