// Inner loops of tensor-product evaluation, shared by all kinds. Private to core/patch.
//
// A point source is any callable point(i, j) -> Vec4 of homogeneous control points (w xyz, w), i along u.
#pragma once

#include "core/math/bernstein.h"
#include "core/patch/patch.h"

namespace patchmill::internal {

struct HomogeneousJet {
  Vec4 p, du, dv, duu, duv, dvv;
};

// Sum over (degree_u + 1) x (degree_v + 1) points of products of basis functions. Constant degrees unroll.
template <class PointSource>
inline HomogeneousJet TensorJet(int degree_u, int degree_v, const BasisJet& bu, const BasisJet& bv,
                                const PointSource& point) {
  HomogeneousJet h;
  h.p = h.du = h.dv = h.duu = h.duv = h.dvv = Vec4::Zero();
  for (int i = 0; i <= degree_u; ++i) {
    Vec4 r = Vec4::Zero(), rv = Vec4::Zero(), rvv = Vec4::Zero();
    for (int j = 0; j <= degree_v; ++j) {
      const Vec4 q = point(i, j);
      r += bv.f[j] * q;
      rv += bv.d[j] * q;
      rvv += bv.dd[j] * q;
    }
    h.p += bu.f[i] * r;
    h.du += bu.d[i] * r;
    h.duu += bu.dd[i] * r;
    h.dv += bu.f[i] * rv;
    h.duv += bu.d[i] * rv;
    h.dvv += bu.f[i] * rvv;
  }
  return h;
}

template <class PointSource>
inline Vec4 TensorPoint(int degree_u, int degree_v, const double* bu, const double* bv,
                        const PointSource& point) {
  Vec4 p = Vec4::Zero();
  for (int i = 0; i <= degree_u; ++i) {
    Vec4 r = Vec4::Zero();
    for (int j = 0; j <= degree_v; ++j) r += bv[j] * point(i, j);
    p += bu[i] * r;
  }
  return p;
}

// The jet in space: xyz as it is (polynomial), or xyz / w by the quotient rule (rational).
inline SurfaceJet PolynomialJet(const HomogeneousJet& h) {
  SurfaceJet s;
  s.p = h.p.head<3>();
  s.du = h.du.head<3>();
  s.dv = h.dv.head<3>();
  s.duu = h.duu.head<3>();
  s.duv = h.duv.head<3>();
  s.dvv = h.dvv.head<3>();
  return s;
}

inline SurfaceJet RationalJet(const HomogeneousJet& h) {
  SurfaceJet s;
  const double r = 1.0 / h.p.w();
  const double wu = h.du.w(), wv = h.dv.w();
  s.p = h.p.head<3>() * r;
  s.du = (h.du.head<3>() - wu * s.p) * r;
  s.dv = (h.dv.head<3>() - wv * s.p) * r;
  s.duu = (h.duu.head<3>() - 2.0 * wu * s.du - h.duu.w() * s.p) * r;
  s.duv = (h.duv.head<3>() - wu * s.dv - wv * s.du - h.duv.w() * s.p) * r;
  s.dvv = (h.dvv.head<3>() - 2.0 * wv * s.dv - h.dvv.w() * s.p) * r;
  return s;
}

// Homogeneous form of a Cartesian point list with optional weights.
inline Vec4 Homogeneous(const std::vector<Vec3>& points, const std::vector<double>& weights, int k) {
  const Vec3& p = points[static_cast<std::size_t>(k)];
  if (weights.empty()) return {p.x(), p.y(), p.z(), 1.0};
  const double w = weights[static_cast<std::size_t>(k)];
  return {w * p.x(), w * p.y(), w * p.z(), w};
}

}  // namespace patchmill::internal
