// Brown quad: two lofts of general boundary curves, blended by squared weights.
//
// Each row (curve or rail of v=0, v=1) is its cubic Hermite part plus a rest that vanishes to second order at
// both ends; columns likewise. With H1, H2 the bicubics of the Hermite parts, X, Y the lofts of the rests,
//   S = H2 + lambda (H1 - H2) + lambda X + (1 - lambda) Y,   lambda = p/(p+q), 1 - lambda = q/(p+q),
// and H1 - H2 has only its four inner Bezier points: nothing cancels near a corner.
#include "core/math/tensor_bernstein.h"
#include "core/patch/kinds.h"
#include "core/patch/tensor_kernel.h"

namespace patchmill::internal {
namespace {

constexpr int kMaxRow = kMaxBrownDegree + 1;

// The four curves of one loft, in order from parameter 0 to 1 across: edge, rail, rail, edge.
struct Loft {
  int degree = 0;
  Vec3 row[4][kMaxRow];
};

struct Lofts {
  Loft u, v;  // rows along u (lofted across v), columns along v (lofted across u)
};

Lofts LoftsOf(const BrownPatch& patch) {
  const int n = patch.degree_u, m = patch.degree_v;
  const Vec3* next = patch.points.data();
  Lofts l;
  l.u.degree = n;
  l.v.degree = m;
  const auto read = [&next](Vec3* row, int first, int last) {
    for (int k = first; k <= last; ++k) row[k] = *next++;
  };
  read(l.u.row[0], 0, n);
  read(l.u.row[3], 0, n);
  read(l.v.row[0], 1, m - 1);
  read(l.v.row[3], 1, m - 1);
  read(l.u.row[1], 1, n - 1);
  read(l.u.row[2], 1, n - 1);
  read(l.v.row[1], 1, m - 1);
  read(l.v.row[2], 1, m - 1);
  for (const int side : {0, 3}) {
    l.v.row[side][0] = l.u.row[0][side == 0 ? 0 : n];
    l.v.row[side][m] = l.u.row[3][side == 0 ? 0 : n];
  }
  // A rail starts a third of the crossing edge's end derivative beside the corner.
  const auto beside = [](const Vec3* row, int degree, bool end) -> Vec3 {
    const Vec3& corner = row[end ? degree : 0];
    return corner + degree / 3.0 * (row[end ? degree - 1 : 1] - corner);
  };
  for (const bool end : {false, true}) {
    l.u.row[1][end ? n : 0] = beside(l.v.row[end ? 3 : 0], m, false);
    l.u.row[2][end ? n : 0] = beside(l.v.row[end ? 3 : 0], m, true);
    l.v.row[1][end ? m : 0] = beside(l.u.row[end ? 3 : 0], n, false);
    l.v.row[2][end ? m : 0] = beside(l.u.row[end ? 3 : 0], n, true);
  }
  return l;
}

// Bezier points of the cubic with a row's ends and end derivatives.
void HermitePart(const Vec3* row, int n, Vec3 cubic[4]) {
  cubic[0] = row[0];
  cubic[1] = row[0] + n / 3.0 * (row[1] - row[0]);
  cubic[2] = row[n] + n / 3.0 * (row[n - 1] - row[n]);
  cubic[3] = row[n];
}

// Inner Bernstein coefficients 2..n-2 of row - cubic (the others are zero): rest[0..n-4].
int RestOf(const Vec3* row, int n, const Vec3 cubic[4], Vec3* rest) {
  Vec3 high[kMaxRow];
  for (int k = 0; k < 4; ++k) high[k] = cubic[k];
  for (int d = 4; d <= n; ++d) {
    high[d] = high[d - 1];
    for (int i = d - 1; i >= 1; --i) {
      const double a = static_cast<double>(i) / d;
      high[i] = a * high[i - 1] + (1.0 - a) * high[i];
    }
  }
  for (int k = 2; k <= n - 2; ++k) rest[k - 2] = row[k] - high[k];
  return n - 3;
}

struct Blend {
  Jet2 lambda, rest;  // p/(p+q), q/(p+q)
};
Blend BlendAt(double u, double v) {
  const double a = u * (1.0 - u), da = 1.0 - 2.0 * u, b = v * (1.0 - v), db = 1.0 - 2.0 * v;
  const Jet2 p{a * a, 2.0 * a * da, 0.0, 2.0 * da * da - 4.0 * a, 0.0, 0.0};
  const Jet2 q{b * b, 0.0, 2.0 * b * db, 0.0, 0.0, 2.0 * db * db - 4.0 * b};
  const Jet2 sum = p + q;
  if (!(sum.f > kNothing * kNothing)) return {Jet2::Constant(0.5), Jet2::Constant(0.5)};
  return {p / sum, q / sum};
}

bool NearCorner(double u, double v) {
  return (u < kCornerRadius || 1.0 - u < kCornerRadius) && (v < kCornerRadius || 1.0 - v < kCornerRadius);
}

Jet2 Basis(const BasisJet& bu, int i, const BasisJet& bv, int j) {
  return {bu.f[i] * bv.f[j],  bu.d[i] * bv.f[j], bu.f[i] * bv.d[j],
          bu.dd[i] * bv.f[j], bu.d[i] * bv.d[j], bu.f[i] * bv.dd[j]};
}

}  // namespace

SurfaceJet EvaluateShape(const BrownPatch& patch, double u, double v) {
  const Lofts lofts = LoftsOf(patch);
  const int n = lofts.u.degree, m = lofts.v.degree;
  BasisJet bu, bv, bn, bm;
  AllBernsteinJet(3, u, bu);
  AllBernsteinJet(3, v, bv);
  AllBernsteinJet(n, u, bn);
  AllBernsteinJet(m, v, bm);
  const Blend blend = BlendAt(u, v);
  const bool corner = NearCorner(u, v);
  SurfaceJet s;
  Vec3 first[4][4], second[4][4];  // H1[i][j], H2[i][j]
  Vec3 rest[kMaxRow];
  for (int k = 0; k < 4; ++k) {
    Vec3 cubic[4];
    HermitePart(lofts.u.row[k], n, cubic);
    for (int i = 0; i < 4; ++i) first[i][k] = cubic[i];
    int count = RestOf(lofts.u.row[k], n, cubic, rest);
    for (int l = 0; l < count; ++l) {
      const Jet2 basis = Basis(bn, l + 2, bv, k);
      Jet2 phi = blend.lambda * basis;
      if (corner) phi.uu = basis.uu, phi.uv = phi.vv = 0.0;  // the edge's own second derivative
      AddTerm(phi, rest[l], s);
    }
    HermitePart(lofts.v.row[k], m, second[k]);
    count = RestOf(lofts.v.row[k], m, second[k], rest);
    for (int l = 0; l < count; ++l) {
      const Jet2 basis = Basis(bu, k, bm, l + 2);
      Jet2 phi = blend.rest * basis;
      if (corner) phi.vv = basis.vv, phi.uv = phi.uu = 0.0;
      AddTerm(phi, rest[l], s);
    }
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const Jet2 basis = Basis(bu, i, bv, j);
      AddTerm(basis, second[i][j], s);
      if (i == 0 || i == 3 || j == 0 || j == 3) continue;
      Jet2 phi = blend.lambda * basis;
      if (corner) phi.uu = phi.vv = 0.0, phi.uv = 0.5 * basis.uv;  // the mean of the two twists
      AddTerm(phi, first[i][j] - second[i][j], s);
    }
  }
  return s;
}

Vec3 ShapePosition(const BrownPatch& patch, double u, double v) {
  const Lofts lofts = LoftsOf(patch);
  double bu[4], bv[4], bn[kMaxRow], bm[kMaxRow];
  AllBernstein(3, u, bu);
  AllBernstein(3, v, bv);
  AllBernstein(lofts.u.degree, u, bn);
  AllBernstein(lofts.v.degree, v, bm);
  Vec3 s1 = Vec3::Zero(), s2 = Vec3::Zero();
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i <= lofts.u.degree; ++i) s1 += bv[k] * bn[i] * lofts.u.row[k][i];
    for (int j = 0; j <= lofts.v.degree; ++j) s2 += bu[k] * bm[j] * lofts.v.row[k][j];
  }
  const double a = u * (1.0 - u), b = v * (1.0 - v), p = a * a, q = b * b;
  const double lambda = p + q > 0.0 ? p / (p + q) : 0.5;
  return s2 + lambda * (s1 - s2);
}

// (p S1 + q S2) / (p + q), times one where needed to reach degrees n + 4, m + 4.
std::vector<Piece> ShapePieces(const BrownPatch& patch) {
  const Lofts lofts = LoftsOf(patch);
  const int n = lofts.u.degree, m = lofts.v.degree;
  ScaledBernstein<Vec4> s1(n, 3, Vec4::Zero()), s2(3, m, Vec4::Zero()), net(n + 4, m + 4, Vec4::Zero());
  ScaledBernstein<double> p(4, m + 1, 0.0), q(n + 1, 4, 0.0);
  const auto put = [](const Vec3& x, double factor) { return Vec4(factor * Vec4(x.x(), x.y(), x.z(), 1.0)); };
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i <= n; ++i) s1(i, k) = put(lofts.u.row[k][i], Binomial(n, i) * Binomial(3, k));
    for (int j = 0; j <= m; ++j) s2(k, j) = put(lofts.v.row[k][j], Binomial(m, j) * Binomial(3, k));
  }
  for (int k = 0; k <= m + 1; ++k) p(2, k) = Binomial(m + 1, k);
  for (int k = 0; k <= n + 1; ++k) q(k, 2) = Binomial(n + 1, k);
  s1.MultiplyInto(p, net);
  s2.MultiplyInto(q, net);
  std::vector<Piece> pieces(1);
  pieces[0].net = {n + 4, m + 4, true, net.Unscaled()};
  pieces[0].shape = std::make_shared<const PatchShape>(patch);
  pieces[0].native = NativeRectangle(0, 1, 0, 1);
  return pieces;
}

}  // namespace patchmill::internal
