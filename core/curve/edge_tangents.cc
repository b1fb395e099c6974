#include "core/curve/edge_tangents.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {

absl::StatusOr<Vec3> FmillTangent(const Vec3& chord, const Vec3& normal, double gamma) {
  if (!(gamma > 0.0 && gamma <= 10.0)) {
    return absl::InvalidArgumentError(fmt::format("gamma = {:g}; must be in (0, 10]", gamma));
  }
  const double length = chord.norm();
  if (!(length > 0.0)) return absl::InvalidArgumentError("the ends of the edge are the same point");
  const Vec3 projected = chord - normal * normal.dot(chord);
  if (!(projected.norm() > kMinProjection * length)) {
    return absl::InvalidArgumentError(
        "the chord of the edge is parallel to the normal at its end; give the tangent there");
  }
  return Vec3(gamma * length * projected.normalized());
}

absl::StatusOr<EdgeTangents> FmillTangents(const Vec3& p1, const Vec3& n1, const Vec3& p2, const Vec3& n2,
                                           double gamma) {
  EdgeTangents tangents;
  PM_ASSIGN_OR_RETURN(tangents.t1, FmillTangent(p2 - p1, n1, gamma));
  PM_ASSIGN_OR_RETURN(tangents.t2, FmillTangent(p1 - p2, n2, gamma));
  return tangents;
}

double ArcTangentLength(double chord, double angle) {
  return chord * 2.0 * std::tan(0.25 * angle) / std::sin(0.5 * angle);
}

absl::StatusOr<EdgeTangents> QuarterEllipseTangents(const Vec3& p1, const Vec3& direction1, const Vec3& p2,
                                                    const Vec3& direction2) {
  const Vec3 chord = p2 - p1;
  const Vec3 u1 = direction1.normalized(), u2 = direction2.normalized();
  const Vec3 cross = u1.cross(u2);
  const double sine2 = cross.squaredNorm();
  if (!(sine2 > 1e-18)) {
    return absl::InvalidArgumentError("the end directions are parallel; a quarter ellipse needs two");
  }
  // p1 + s1 u1 and p2 + s2 u2 are the nearest points of the two lines.
  const double s1 = chord.cross(u2).dot(cross) / sine2, s2 = chord.cross(u1).dot(cross) / sine2;
  const double apart = std::abs(chord.dot(cross)) / std::sqrt(sine2);
  if (!(s1 > 0.0 && s2 > 0.0)) {
    return absl::InvalidArgumentError("the end directions do not meet ahead of both ends");
  }
  if (!(apart <= 1e-6 * chord.norm())) {
    return absl::InvalidArgumentError(
        fmt::format("the end directions pass each other at {:g}; must meet within 1e-6 of the chord", apart));
  }
  const double factor = 4.0 * (std::sqrt(2.0) - 1.0);
  return EdgeTangents{factor * s1 * u1, factor * s2 * u2};
}

}  // namespace patchmill
