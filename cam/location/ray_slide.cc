#include "cam/location/ray_slide.h"

#include <algorithm>

#include "cam/location/ray_distance.h"
#include "core/math/box_qp.h"

namespace patchmill {
namespace {

constexpr int kMaxHalvings = 12;
constexpr double kDescent = 1e-4;  // share of the promised decrease that a step must reach
constexpr double kUnseen = 1e-13;  // share of f; rounding hides a smaller decrease, and the step is taken

// Whether the place lies on that side of its piece (-1: none). A shortened step ends before the side that it
// was aimed at.
bool IsOn(int side, const SurfacePoint& at) {
  switch (side) {
    case 0:
      return at.v <= 0.0;
    case 1:
      return at.u >= 1.0;
    case 2:
      return at.v >= 1.0;
    case 3:
      return at.u <= 0.0;
    default:
      return false;
  }
}

}  // namespace

RaySlide::RaySlide(const Surface& surface, const SurfacePoint& from)
    : surface_(&surface), at_(from), jet_(Evaluate(surface, from.piece, from.u, from.v)) {
  at_.p = jet_.p;
}

double RaySlide::Step(const Vec3& c) {
  const Vec3 d = internal::ToRay(at_.p, c);
  const double f = 0.5 * d.squaredNorm();
  // Above c only the distance in plan counts.
  const bool above = !(d.z() > 0.0);
  const Vec3 du = above ? Vec3(jet_.du.x(), jet_.du.y(), 0.0) : jet_.du;
  const Vec3 dv = above ? Vec3(jet_.dv.x(), jet_.dv.y(), 0.0) : jet_.dv;
  const double tiny = 1e-14 * (jet_.du.squaredNorm() + jet_.dv.squaredNorm()) + 1e-300;
  const double e = du.squaredNorm() + tiny, m = du.dot(dv), g = dv.squaredNorm() + tiny;
  Quadratic2 q{e - d.dot(jet_.duu), m - d.dot(jet_.duv), g - d.dot(jet_.dvv), -d.dot(du), -d.dot(dv)};
  constexpr double kSmall = 1e-6;
  if (!(q.a > kSmall * e && q.c > kSmall * g && q.a * q.c - q.b * q.b > kSmall * e * g)) {
    q.a = e;
    q.b = m;
    q.c = g;
  }
  const Box2 box{-at_.u, 1.0 - at_.u, -at_.v, 1.0 - at_.v};
  const BoxMinimum to = MinimizeOnBox(q, box);
  const int aimed = to.y == box.y0 ? 0 : to.x == box.x1 ? 1 : to.y == box.y1 ? 2 : to.x == box.x0 ? 3 : -1;
  held_by_ = IsOn(aimed, at_) ? aimed : -1;
  if (!(to.value < 0.0)) return 0.0;
  double t = 1.0;
  for (int k = 0; k < kMaxHalvings; ++k, t *= 0.5) {
    SurfacePoint next = at_;
    next.u = std::clamp(at_.u + t * to.x, 0.0, 1.0);
    next.v = std::clamp(at_.v + t * to.y, 0.0, 1.0);
    const SurfaceJet jet = Evaluate(*surface_, at_.piece, next.u, next.v);
    next.p = jet.p;
    const double next_f = 0.5 * internal::ToRay(jet.p, c).squaredNorm();
    if (next_f > f + kDescent * t * to.value && -to.value > kUnseen * f) continue;
    const double length = (next.p - at_.p).norm();
    at_ = next;
    jet_ = jet;
    held_by_ = IsOn(aimed, at_) ? aimed : -1;
    return length;
  }
  return 0.0;
}

}  // namespace patchmill
