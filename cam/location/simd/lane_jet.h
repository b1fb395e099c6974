// Position and derivatives of a piece, each lane at its own parameters. There are versions for bicubics with
// constant degrees, for any net and for Gregory quads. The formulas are those of core/patch, where their
// sources are cited.
#pragma once

#include "cam/location/simd/lane_types.h"
#include "core/math/bernstein.h"
#include "core/patch/gregory_layout.h"

namespace patchmill::internal::PM_LANES {

struct Jet {
  V3 p, du, dv, duu, duv, dvv;
};

struct Basis {
  D f[kMaxBasisDegree + 1], d[kMaxBasisDegree + 1], dd[kMaxBasisDegree + 1];
};

PM_LANE_INLINE void RaiseBasis(int n, D t, D* b) {
  const D s = 1.0 - t;
  D left{};
  for (int i = 0; i < n; ++i) {
    const D here = b[i];
    b[i] = s * here + left;
    left = t * here;
  }
  b[n] = left;
}

// As AllBernsteinJet.
PM_LANE_INLINE void MakeBasis(int n, D t, Basis& out) {
  D lower[kMaxBasisDegree + 1];
  lower[0] = Splat(1.0);
  for (int k = 1; k <= n - 2; ++k) RaiseBasis(k, t, lower);
  if (n >= 2) {
    const double c = static_cast<double>(n) * (n - 1);
    for (int i = 0; i <= n; ++i) {
      const D a = i >= 2 ? lower[i - 2] : D{};
      const D b = i >= 1 && i <= n - 1 ? lower[i - 1] : D{};
      const D e = i <= n - 2 ? lower[i] : D{};
      out.dd[i] = c * (a - 2.0 * b + e);
    }
    RaiseBasis(n - 1, t, lower);
  } else {
    for (int i = 0; i <= n; ++i) out.dd[i] = D{};
  }
  for (int i = 0; i <= n; ++i) {
    const D a = i >= 1 ? lower[i - 1] : D{};
    const D b = i <= n - 1 ? lower[i] : D{};
    out.d[i] = n * (a - b);
  }
  if (n >= 1) RaiseBasis(n, t, lower);
  for (int i = 0; i <= n; ++i) out.f[i] = lower[i];
}

PM_LANE_INLINE void MakeCubicBasis(D t, Basis& out) {
  const D s = 1.0 - t, ss = s * s, tt = t * t, st = s * t;
  out.f[0] = ss * s;
  out.f[1] = 3.0 * (ss * t);
  out.f[2] = 3.0 * (tt * s);
  out.f[3] = tt * t;
  out.d[0] = -3.0 * ss;
  out.d[1] = 3.0 * (ss - 2.0 * st);
  out.d[2] = 3.0 * (2.0 * st - tt);
  out.d[3] = 3.0 * tt;
  out.dd[0] = 6.0 * s;
  out.dd[1] = 6.0 * (t - 2.0 * s);
  out.dd[2] = 6.0 * (s - 2.0 * t);
  out.dd[3] = 6.0 * t;
}

// point(i, j) returns const double* to x y z. Loops over constant degrees are unrolled. The degrees are
// parameters of their own, because the compiler unrolls only over what it sees as constants.
template <class PointSource>
PM_LANE_INLINE void PolynomialJet(int degree_u, int degree_v, const Basis& bu, const Basis& bv,
                                  const PointSource& point, Jet& jet) {
  jet.p = jet.du = jet.dv = jet.duu = jet.duv = jet.dvv = Zero3();
  for (int i = 0; i <= degree_u; ++i) {
    V3 r = Zero3(), rv = Zero3(), rvv = Zero3();
    for (int j = 0; j <= degree_v; ++j) {
      const double* q = point(i, j);
      AddTimes(r, bv.f[j], q);
      AddTimes(rv, bv.d[j], q);
      AddTimes(rvv, bv.dd[j], q);
    }
    AddTimes(jet.p, bu.f[i], r);
    AddTimes(jet.du, bu.d[i], r);
    AddTimes(jet.duu, bu.dd[i], r);
    AddTimes(jet.dv, bu.f[i], rv);
    AddTimes(jet.duv, bu.d[i], rv);
    AddTimes(jet.dvv, bu.f[i], rvv);
  }
}

// Divides a homogeneous jet by that of its weight (quotient rule). The parameters are those of PolynomialJet,
// for the same reason.
PM_LANE_INLINE void DivideByWeight(int degree_u, int degree_v, const Basis& bu, const Basis& bv,
                                   const double* points, Jet& jet) {
  D w{}, wu{}, wv{}, wuu{}, wuv{}, wvv{};
  for (int i = 0; i <= degree_u; ++i) {
    D r{}, rv{}, rvv{};
    for (int j = 0; j <= degree_v; ++j) {
      const double q = points[4 * (i * (degree_v + 1) + j) + 3];
      r += bv.f[j] * q;
      rv += bv.d[j] * q;
      rvv += bv.dd[j] * q;
    }
    w += bu.f[i] * r;
    wu += bu.d[i] * r;
    wuu += bu.dd[i] * r;
    wv += bu.f[i] * rv;
    wuv += bu.d[i] * rv;
    wvv += bu.f[i] * rvv;
  }
  const D r = 1.0 / w;
  const auto divide = [&](D & p, D & du, D & dv, D & duu, D & duv, D & dvv) __attribute__((always_inline)) {
    p = p * r;
    du = (du - wu * p) * r;
    dv = (dv - wv * p) * r;
    duu = (duu - 2.0 * wu * du - wuu * p) * r;
    duv = (duv - wu * dv - wv * du - wuv * p) * r;
    dvv = (dvv - 2.0 * wv * dv - wvv * p) * r;
  };
  divide(jet.p.x, jet.du.x, jet.dv.x, jet.duu.x, jet.duv.x, jet.dvv.x);
  divide(jet.p.y, jet.du.y, jet.dv.y, jet.duu.y, jet.duv.y, jet.dvv.y);
  divide(jet.p.z, jet.du.z, jet.dv.z, jet.duu.z, jet.duv.z, jet.dvv.z);
}

// A function of one variable with two derivatives.
struct Curve {
  D f, d, dd;
};

// The blended terms. At each corner, lambda B_i B_j D = 9 M(u) N(v) h(p(u), q(v)) D with h = p^2 q / (p + q).
// h is smooth except at the corner and has bounded second derivatives there. Corner blend: p = a is the
// distance from the corner, M = (1 - a)^2. Edge blend: p = a (1 - a), M = 1 - a.
PM_LANE_INLINE void AddBlend(const double* points, bool edge_blend, D u, D v, Jet& jet) {
  for (const GregoryCorner& c : kGregoryCorners) {
    const bool high_u = c.i == 2, high_v = c.j == 2;
    const D a = high_u ? 1.0 - u : u, b = high_v ? 1.0 - v : v;
    const D one = Splat(1.0), a1 = 1.0 - a, b1 = 1.0 - b;
    Curve p{a, one, D{}}, q{b, one, D{}}, m{a1 * a1, -2.0 * a1, Splat(2.0)},
        n{b1 * b1, -2.0 * b1, Splat(2.0)};
    if (edge_blend) {
      p = {a * a1, a1 - a, Splat(-2.0)};
      q = {b * b1, b1 - b, Splat(-2.0)};
      m = {a1, -one, D{}};
      n = {b1, -one, D{}};
    }
    const D r = 1.0 / Max(p.f + q.f, Splat(1e-90));
    const D t = p.f * r, s = q.f * r, ss = s * s, tt = t * t;
    const D h = p.f * q.f * t, hp = q.f * (1.0 - ss), hq = p.f * tt;
    const D hpp = 2.0 * (ss * s), hpq = 1.0 - ss * (1.0 + 2.0 * t), hqq = -2.0 * (tt * t);
    const D ha = hp * p.d, hb = hq * q.d;
    const D haa = hpp * (p.d * p.d) + hp * p.dd, hab = hpq * (p.d * q.d), hbb = hqq * (q.d * q.d) + hq * q.dd;
    const double su = high_u ? -1.0 : 1.0, sv = high_v ? -1.0 : 1.0;
    const D m9 = 9.0 * m.f, n9 = 9.0 * n.f;
    const D ga = m.d * h + m.f * ha;  // derivative of M h
    const D phi = m9 * n.f * h, phi_u = su * (n9 * ga), phi_v = sv * (m9 * (n.d * h + n.f * hb));
    const D phi_uu = n9 * (m.dd * h + 2.0 * (m.d * ha) + m.f * haa);
    const D phi_vv = m9 * (n.dd * h + 2.0 * (n.d * hb) + n.f * hbb);
    const D phi_uv = (9.0 * su * sv) * (n.d * ga + n.f * (m.d * hb + m.f * hab));
    const double *x = points + 3 * c.first, *y = points + 3 * c.second;
    const double d[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
    AddTimes(jet.p, phi, d);
    AddTimes(jet.du, phi_u, d);
    AddTimes(jet.dv, phi_v, d);
    AddTimes(jet.duu, phi_uu, d);
    AddTimes(jet.duv, phi_uv, d);
    AddTimes(jet.dvv, phi_vv, d);
  }
}

PM_LANE_INLINE void EvaluateLanes(const LaneNet& net, D u, D v, Jet& jet) {
  Basis bu, bv;
  if (net.gregory != nullptr) {
    MakeCubicBasis(u, bu);
    MakeCubicBasis(v, bv);
    PolynomialJet(
        3, 3, bu, bv,
        [&](int i, int j) __attribute__((always_inline)) { return net.gregory + 3 * kGregoryNet[4 * i + j]; },
        jet);
    AddBlend(net.gregory, net.edge_blend, u, v, jet);
    return;
  }
  if (net.degree_u == 3 && net.degree_v == 3) {
    MakeCubicBasis(u, bu);
    MakeCubicBasis(v, bv);
    PolynomialJet(
        3, 3, bu,
        bv, [&](int i, int j) __attribute__((always_inline)) { return net.points + 4 * (4 * i + j); }, jet);
  } else {
    MakeBasis(net.degree_u, u, bu);
    MakeBasis(net.degree_v, v, bv);
    const int row = net.degree_v + 1;
    PolynomialJet(
        net.degree_u, net.degree_v, bu,
        bv, [&](int i, int j) __attribute__((always_inline)) { return net.points + 4 * (i * row + j); }, jet);
  }
  if (net.rational) DivideByWeight(net.degree_u, net.degree_v, bu, bv, net.points, jet);
}

}  // namespace patchmill::internal::PM_LANES
