#include "cam/location/gregory_bounds.h"

#include <algorithm>

#include "core/patch/gregory_layout.h"

namespace patchmill::internal {
namespace {

Interval operator+(const Interval& a, const Interval& b) { return {a.lo + b.lo, a.hi + b.hi}; }
Interval operator*(const Interval& a, const Interval& b) {
  const auto [lo, hi] = std::minmax({a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi});
  return {lo, hi};
}
Interval operator*(double t, const Interval& a) {
  return t < 0.0 ? Interval{t * a.hi, t * a.lo} : Interval{t * a.lo, t * a.hi};
}

// The range of f over [x.lo, x.hi], for a monotonic function f.
template <class F>
Interval Monotonic(const Interval& x, const F& f) {
  const double a = f(x.lo), b = f(x.hi);
  return {std::min(a, b), std::max(a, b)};
}

// A function of one variable and its derivatives, as ranges.
struct Curve {
  Interval f, d, dd;
};

// p and M of the term 9 M(a) N(b) h(p(a), q(b)) with h = p^2 q / (p + q); a is the distance from the corner.
void OneVariable(bool edge_blend, const Interval& a, Curve& p, Curve& m) {
  const Interval rest = Monotonic(a, [](double x) { return 1.0 - x; });
  if (edge_blend) {
    p.f = Monotonic(a, [](double x) { return x * (1.0 - x); });
    if (a.lo < 0.5 && a.hi > 0.5) p.f = {std::min(p.f.lo, p.f.hi), 0.25};
    p.d = Monotonic(a, [](double x) { return 1.0 - 2.0 * x; });
    p.dd = {-2.0, -2.0};
    m = {rest, {-1.0, -1.0}, {0.0, 0.0}};
  } else {
    p = {a, {1.0, 1.0}, {0.0, 0.0}};
    m = {Monotonic(rest, [](double x) { return x * x; }), -2.0 * rest, {2.0, 2.0}};
  }
}

BlendedTerm BoundTerm(bool edge_blend, const Interval& a, const Interval& b) {
  Curve p, q, m, n;
  OneVariable(edge_blend, a, p, m);
  OneVariable(edge_blend, b, q, n);
  // In the shares s = q/(p+q) and t = 1 - s all derivatives of h are monotonic.
  const auto share = [](double x, double y) { return x + y > 0.0 ? x / (x + y) : 0.5; };
  const Interval s{p.f.hi > 0.0 ? share(q.f.lo, p.f.hi) : 0.0, q.f.hi > 0.0 ? share(q.f.hi, p.f.lo) : 1.0};
  const Interval t{1.0 - s.hi, 1.0 - s.lo};
  const Interval h = p.f * q.f * t;
  const Interval hp = q.f * Monotonic(s, [](double x) { return 1.0 - x * x; });
  const Interval hq = p.f * Monotonic(t, [](double x) { return x * x; });
  const Interval hpp = Monotonic(s, [](double x) { return 2.0 * x * x * x; });
  const Interval hpq = Monotonic(s, [](double x) { return 1.0 - x * x * (3.0 - 2.0 * x); });
  const Interval hqq = Monotonic(t, [](double x) { return -2.0 * x * x * x; });
  const Interval ha = hp * p.d, hb = hq * q.d;
  const Interval haa = hpp * (p.d * p.d) + hp * p.dd, hab = hpq * (p.d * q.d),
                 hbb = hqq * (q.d * q.d) + hq * q.dd;
  const Interval ga = m.d * h + m.f * ha;
  BlendedTerm term;
  term.u = 9.0 * (n.f * ga);
  term.v = 9.0 * (m.f * (n.d * h + n.f * hb));
  term.uu = 9.0 * (n.f * (m.dd * h + 2.0 * (m.d * ha) + m.f * haa));
  term.vv = 9.0 * (m.f * (n.dd * h + 2.0 * (n.d * hb) + n.f * hbb));
  term.uv = 9.0 * (n.d * ga + n.f * (m.d * hb + m.f * hab));
  return term;
}

}  // namespace

std::array<BlendedTerm, 4> BoundBlend(const GregoryPatch& patch, const Rect& rect) {
  const double lu = rect.u1 - rect.u0, lv = rect.v1 - rect.v0;
  std::array<BlendedTerm, 4> terms;
  for (std::size_t k = 0; k < 4; ++k) {
    const GregoryCorner& c = kGregoryCorners[k];
    const bool high_u = c.i == 2, high_v = c.j == 2;
    const Interval a = high_u ? Interval{1.0 - rect.u1, 1.0 - rect.u0} : Interval{rect.u0, rect.u1};
    const Interval b = high_v ? Interval{1.0 - rect.v1, 1.0 - rect.v0} : Interval{rect.v0, rect.v1};
    BlendedTerm& term = terms[k];
    term = BoundTerm(patch.blend == GregoryPatch::Blend::kEdge, a, b);
    const double su = high_u ? -lu : lu, sv = high_v ? -lv : lv;
    term.u = su * term.u;
    term.v = sv * term.v;
    term.uu = (su * su) * term.uu;
    term.uv = (su * sv) * term.uv;
    term.vv = (sv * sv) * term.vv;
    term.d =
        patch.points[static_cast<std::size_t>(c.first)] - patch.points[static_cast<std::size_t>(c.second)];
  }
  return terms;
}

std::array<Vec4, 16> BicubicPart(const GregoryPatch& patch) {
  std::array<Vec4, 16> net;
  for (std::size_t k = 0; k < 16; ++k) net[k] << patch.points[static_cast<std::size_t>(kGregoryNet[k])], 1.0;
  return net;
}

}  // namespace patchmill::internal
