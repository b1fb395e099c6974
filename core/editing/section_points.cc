#include "core/editing/section_points.h"

namespace patchmill {

MiddleCross AcrossMiddle(const PatchShape& quad, int side) {
  const double u = side == 1 ? 1.0 : side == 3 ? 0.0 : 0.5, v = side == 0 ? 0.0 : side == 2 ? 1.0 : 0.5;
  const SurfaceJet s = Evaluate(quad, u, v);
  const double inward = side == 0 || side == 3 ? 1.0 : -1.0;
  const bool along_u = side % 2 == 0;
  return {s.p, inward * (along_u ? s.dv : s.du), along_u ? s.dvv : s.duu, s.du.cross(s.dv).normalized()};
}

SectionPoints SectionPointsOf(const MiddleCross& cross) {
  const Vec3 q1 = cross.p + cross.first / 5.0;
  return {cross.p, q1, 2.0 * q1 - cross.p + cross.second / 20.0};
}

MiddleCross CrossOf(const SectionPoints& q) {
  return {q.q0, 5.0 * (q.q1 - q.q0), 20.0 * (q.q2 - 2.0 * q.q1 + q.q0), Vec3::Zero()};
}

Vec3 SectionCurvature(const Vec3& first, const Vec3& second) {
  const double square = first.squaredNorm();
  return (second - first * (first.dot(second) / square)) / square;
}

Vec3 SecondForCurvature(const MiddleCross& cross, double wanted) {
  const Vec3 bend = SectionCurvature(cross.first, cross.second);
  if (bend.norm() > 1e-12 / cross.first.norm()) {
    const double sign = bend.dot(cross.normal) < 0.0 ? -1.0 : 1.0;
    return cross.second * (sign * wanted / bend.norm());
  }
  return wanted * cross.first.squaredNorm() * cross.normal;
}

}  // namespace patchmill
