#include "cam/toolpath/segment_metric.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/status.h"
#include "core/surface/net_kernel.h"

namespace patchmill {

namespace {

Vec3 NearestOnPath(const PathSegment& s, const Vec3& p) {
  const Vec3 d = s.b - s.a;
  const double length2 = d.squaredNorm();
  if (!(length2 > 0.0)) return s.a;
  return s.a + std::clamp((p - s.a).dot(d) / length2, 0.0, 1.0) * d;
}

double NearestInXy(const PathSegment& s, const Vec3& p) {
  const double dx = s.b.x() - s.a.x(), dy = s.b.y() - s.a.y();
  const double length2 = dx * dx + dy * dy;
  if (!(length2 > 0.0)) return s.b.z() < s.a.z() ? 1.0 : 0.0;
  return std::clamp(((p.x() - s.a.x()) * dx + (p.y() - s.a.y()) * dy) / length2, 0.0, 1.0);
}

// The squared distance at the parameter t is plan^2 + max(0, z(t) - p_z)^2, convex in t. If the segment lies
// below p at its nearest point in plan, the plan distance is the answer. Otherwise the nearest point of the
// segment itself is the answer if it lies above p. If it does not, the minimum lies where the segment passes
// p's height.
Vec3 NearestOnSwept(const PathSegment& s, const Vec3& p) {
  const double t = NearestInXy(s, p);
  const Vec3 q = s.a + t * (s.b - s.a);
  if (q.z() <= p.z()) return {q.x(), q.y(), p.z()};
  const Vec3 nearest = NearestOnPath(s, p);
  if (nearest.z() >= p.z()) return nearest;
  const double dz = s.b.z() - s.a.z();  // not zero: q lies above p, `nearest` below
  const double crossing = std::clamp((p.z() - s.a.z()) / dz, 0.0, 1.0);
  const Vec3 c = s.a + crossing * (s.b - s.a);
  return {c.x(), c.y(), p.z()};
}

Vec3 NearestOnSweptBox(const PathSegment& s, const Vec3& p) {
  const Vec3 min = s.a.cwiseMin(s.b), max = s.a.cwiseMax(s.b);
  return {std::clamp(p.x(), min.x(), max.x()), std::clamp(p.y(), min.y(), max.y()), std::max(p.z(), min.z())};
}

MetricValue From(const Vec3& nearest, const Vec3& p) {
  MetricValue value;
  const Vec3 d = p - nearest;
  value.distance = d.norm();
  if (value.distance > 0.0) value.gradient = d / value.distance;
  return value;
}

}  // namespace

double DistanceToEither(const PathSegment& a, const PathSegment& b, const Vec3* hull, int count,
                        double enough) {
  const auto n = static_cast<std::size_t>(count);
  PM_CHECK(n <= kMaxNetPoints);
  std::array<double, kMaxNetPoints> to_a, to_b;
  const PathRuler ruler_a(a), ruler_b(b);
  for (std::size_t k = 0; k < n; ++k) {
    to_a[k] = std::sqrt(ruler_a.Distance2(hull[k]));
    to_b[k] = std::sqrt(ruler_b.Distance2(hull[k]));
  }
  const auto at = [&](double share) {
    double most = 0.0;
    for (std::size_t k = 0; k < n; ++k) most = std::max(most, (1.0 - share) * to_a[k] + share * to_b[k]);
    return most;
  };
  // The function is convex in the share, so the interval is narrowed down.
  double low = 0.0, high = 1.0, best = at(0.5);
  for (int i = 0; i < 10 && best > enough; ++i) {
    const double left = low + (high - low) / 3.0, right = high - (high - low) / 3.0;
    const double at_left = at(left), at_right = at(right);
    best = std::min({best, at_left, at_right});
    (at_left < at_right ? high : low) = at_left < at_right ? right : left;
  }
  return best;
}

double PathDistance(const PathSegment& s, const Vec3& p) { return (p - NearestOnPath(s, p)).norm(); }
double SweptDistance(const PathSegment& s, const Vec3& p) { return (p - NearestOnSwept(s, p)).norm(); }
double SweptBoxDistance(const PathSegment& s, const Vec3& p) { return (p - NearestOnSweptBox(s, p)).norm(); }
MetricValue PathDistanceAndGradient(const PathSegment& s, const Vec3& p) {
  return From(NearestOnPath(s, p), p);
}
MetricValue SweptDistanceAndGradient(const PathSegment& s, const Vec3& p) {
  return From(NearestOnSwept(s, p), p);
}
MetricValue SweptBoxDistanceAndGradient(const PathSegment& s, const Vec3& p) {
  return From(NearestOnSweptBox(s, p), p);
}

double ShankDistance(const PathSegment& s, const Vec3& p, double shank_radius) {
  return ShankDistanceAndGradient(s, p, shank_radius).distance;
}

// At the best place t of the segment, 0 = a plan'(t) + (1 - a) rise'(t) for some a in [0,1]. With the same a,
// the gradients of the two terms in p give a subgradient of their smallest maximum.
MetricValue ShankDistanceAndGradient(const PathSegment& s, const Vec3& p, double shank_radius) {
  const Vec3 d = s.b - s.a;
  const auto beside = [&](double t) { return Xy(Vec3(p - s.a - t * d)); };
  const auto plan = [&](double t) { return beside(t).norm(); };
  const auto rise = [&](double t) { return shank_radius - (p.z() - s.a.z() - t * d.z()); };
  double near = NearestInXy(s, p);
  if (plan(near) >= rise(near)) return From(Lift(Xy(p) - beside(near), p.z()), p);
  double low = d.z() < 0.0 ? 1.0 : 0.0;
  if (rise(low) >= plan(low)) return {rise(low), -Vec3::UnitZ()};
  for (int i = 0; i < 50; ++i) {  // the two terms cross between near and low
    const double middle = 0.5 * (near + low);
    (plan(middle) >= rise(middle) ? low : near) = middle;
  }
  const Vec2 out = beside(low).normalized();
  const double plan_rate = -out.dot(Xy(d));
  const double share = d.z() == 0.0 ? 0.0 : std::clamp(d.z() / (d.z() - plan_rate), 0.0, 1.0);
  return {std::max(plan(low), rise(low)), Lift(share * out, share - 1.0)};
}

double ShankBoxDistance(const PathSegment& s, const Vec3& p, double shank_radius) {
  return ShankBoxDistanceAndGradient(s, p, shank_radius).distance;
}

MetricValue ShankBoxDistanceAndGradient(const PathSegment& s, const Vec3& p, double shank_radius) {
  const double rise = shank_radius - (p.z() - std::min(s.a.z(), s.b.z()));
  const MetricValue plan = From(Lift(Xy(NearestOnSweptBox(s, p)), p.z()), p);
  return plan.distance >= rise ? plan : MetricValue{rise, -Vec3::UnitZ()};
}

}  // namespace patchmill
