// Brown quad: two lofts of general boundary curves, blended by squared weights.
//
// Rows may be chains of curves between breaks; a rectangle between breaks sees its own stretch of each. Each
// row (curve or rail of v=0, v=1) is its cubic Hermite part plus a rest that vanishes to second order at both
// ends; columns likewise. With H1, H2 the bicubics of the Hermite parts, X, Y the lofts of the rests,
//   S = H2 + lambda (H1 - H2) + lambda X + (1 - lambda) Y,   lambda = p/(p+q), 1 - lambda = q/(p+q).
// H1 - H2 has only its four inner Bezier points, so nothing cancels near a corner.
#include "core/math/tensor_bernstein.h"
#include "core/patch/bulge.h"
#include "core/patch/kinds.h"
#include "core/patch/tensor_kernel.h"

namespace patchmill::internal {
namespace {

constexpr int kMaxRow = kMaxBrownDegree + 1;

// The stretch of one parameter between two breaks.
struct Span {
  double t0 = 0.0, t1 = 1.0;
  int index = 0;
};

Span SpanNumber(const std::vector<double>& breaks, std::size_t k) {
  return {k > 0 ? breaks[k - 1] : 0.0, k < breaks.size() ? breaks[k] : 1.0, static_cast<int>(k)};
}

Span SpanAt(const std::vector<double>& breaks, double t) {
  std::size_t k = 0;
  while (k < breaks.size() && breaks[k] <= t) ++k;
  return SpanNumber(breaks, k);
}

// The four curves of one loft, in the order of the parameter across them: edge, rail, rail, edge.
struct Loft {
  int degree = 0;
  Span span;
  Vec3 row[4][kMaxRow];  // points on the span
  Vec3 cubic[4][4];      // of the whole row: Bezier points of the cubic with its ends and end derivatives
};

struct Lofts {
  Loft u, v;  // rows along u (lofted across v), columns along v (lofted across u)
};

// Finds the points of a patch by row and side. Sides 0 and 3 are edges, 1 and 2 are rails.
class Rows {
 public:
  explicit Rows(const BrownPatch& patch)
      : patch_(patch),
        n_(patch.degree_u * (static_cast<int>(patch.breaks_u.size()) + 1)),
        m_(patch.degree_v * (static_cast<int>(patch.breaks_v.size()) + 1)) {}

  Vec3 U(int side, int i) const {
    if (side == 0 || side == 3) return Point((side == 0 ? 0 : n_ + 1) + i);
    if (i > 0 && i < n_) return Point(2 * (n_ + m_) + (side == 1 ? 0 : n_ - 1) + i - 1);
    const int edge =
        i == 0 ? 0 : 3;  // a rail starts a third of the crossing edge's derivative beside the corner
    return side == 1 ? StartOf(false, edge) : EndOf(false, edge);
  }
  Vec3 V(int side, int j) const {
    if (side == 0 || side == 3) {
      if (j == 0 || j == m_) return U(j == 0 ? 0 : 3, side == 0 ? 0 : n_);
      return Point(2 * n_ + 2 + (side == 0 ? 0 : m_ - 1) + j - 1);
    }
    if (j > 0 && j < m_) return Point(4 * n_ + 2 * m_ - 2 + (side == 1 ? 0 : m_ - 1) + j - 1);
    const int edge = j == 0 ? 0 : 3;
    return side == 1 ? StartOf(true, edge) : EndOf(true, edge);
  }

  Loft On(bool along_u, const Span& span) const {
    Loft loft;
    loft.degree = along_u ? patch_.degree_u : patch_.degree_v;
    loft.span = span;
    const int first = span.index * loft.degree, last = along_u ? n_ : m_;
    for (int side = 0; side < 4; ++side) {
      for (int k = 0; k <= loft.degree; ++k) loft.row[side][k] = At(along_u, side, first + k);
      loft.cubic[side][0] = At(along_u, side, 0);
      loft.cubic[side][1] = StartOf(along_u, side);
      loft.cubic[side][2] = EndOf(along_u, side);
      loft.cubic[side][3] = At(along_u, side, last);
    }
    return loft;
  }

 private:
  const Vec3& Point(int k) const { return patch_.points[static_cast<std::size_t>(k)]; }
  Vec3 At(bool along_u, int side, int k) const { return along_u ? U(side, k) : V(side, k); }
  // The first point of a row plus (the last point minus) a third of the row's derivative there.
  Vec3 StartOf(bool along_u, int side) const {
    const std::vector<double>& breaks = along_u ? patch_.breaks_u : patch_.breaks_v;
    const int degree = along_u ? patch_.degree_u : patch_.degree_v;
    const Vec3 corner = At(along_u, side, 0);
    return corner + degree / (3.0 * SpanNumber(breaks, 0).t1) * (At(along_u, side, 1) - corner);
  }
  Vec3 EndOf(bool along_u, int side) const {
    const std::vector<double>& breaks = along_u ? patch_.breaks_u : patch_.breaks_v;
    const int degree = along_u ? patch_.degree_u : patch_.degree_v, last = along_u ? n_ : m_;
    const Vec3 corner = At(along_u, side, last);
    return corner + degree / (3.0 * (1.0 - SpanNumber(breaks, breaks.size()).t0)) *
                        (At(along_u, side, last - 1) - corner);
  }

  const BrownPatch& patch_;
  int n_ = 0, m_ = 0;  // degrees times spans
};

Lofts LoftsOf(const BrownPatch& patch, const Span& u, const Span& v) {
  const Rows rows(patch);
  return {rows.On(true, u), rows.On(false, v)};
}

void Restrict(Vec3* points, int degree, const Span& span) {
  if (span.t1 < 1.0) KeepLeft(points, degree, 1, span.t1);
  if (span.t0 > 0.0) KeepRight(points, degree, 1, span.t0 / span.t1);
}

// Bernstein coefficients of row - cubic on the span. They are zero to second order at the ends of the whole
// row.
struct Rest {
  int first = 0, last = 0;  // range of those that are not zero
  Vec3 c[kMaxRow];
};
Rest RestOf(const Loft& loft, int side) {
  const int n = loft.degree;
  Rest rest;
  rest.first = loft.span.t0 == 0.0 ? 2 : 0;
  rest.last = loft.span.t1 == 1.0 ? n - 2 : n;
  Vec3* high = rest.c;
  for (int k = 0; k < 4; ++k) high[k] = loft.cubic[side][k];
  Restrict(high, 3, loft.span);
  for (int d = 4; d <= n; ++d) {
    high[d] = high[d - 1];
    for (int i = d - 1; i >= 1; --i) {
      const double a = static_cast<double>(i) / d;
      high[i] = a * high[i - 1] + (1.0 - a) * high[i];
    }
  }
  for (int k = rest.first; k <= rest.last; ++k) rest.c[k] = loft.row[side][k] - high[k];
  return rest;
}

// The span's Bernstein basis, with derivatives with respect to the parameter of the whole row.
void SpanBasis(const Loft& loft, double t, BasisJet& basis) {
  const double length = loft.span.t1 - loft.span.t0;
  AllBernsteinJet(loft.degree, (t - loft.span.t0) / length, basis);
  for (int k = 0; k <= loft.degree; ++k) basis.d[k] /= length, basis.dd[k] /= length * length;
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
  const Lofts lofts = LoftsOf(patch, SpanAt(patch.breaks_u, u), SpanAt(patch.breaks_v, v));
  BasisJet bu, bv, bn, bm;
  AllBernsteinJet(3, u, bu);
  AllBernsteinJet(3, v, bv);
  SpanBasis(lofts.u, u, bn);
  SpanBasis(lofts.v, v, bm);
  const Blend blend = BlendAt(u, v);
  const bool corner = NearCorner(u, v);
  SurfaceJet s;
  for (int k = 0; k < 4; ++k) {
    const Rest along_u = RestOf(lofts.u, k);
    for (int l = along_u.first; l <= along_u.last; ++l) {
      const Jet2 basis = Basis(bn, l, bv, k);
      Jet2 phi = blend.lambda * basis;
      if (corner) phi.uu = basis.uu, phi.uv = phi.vv = 0.0;  // the edge's own second derivative
      AddTerm(phi, along_u.c[l], s);
    }
    const Rest along_v = RestOf(lofts.v, k);
    for (int l = along_v.first; l <= along_v.last; ++l) {
      const Jet2 basis = Basis(bu, k, bm, l);
      Jet2 phi = blend.rest * basis;
      if (corner) phi.vv = basis.vv, phi.uv = phi.uu = 0.0;
      AddTerm(phi, along_v.c[l], s);
    }
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {  // H1[i][j] = u.cubic[j][i], H2[i][j] = v.cubic[i][j]
      const Jet2 basis = Basis(bu, i, bv, j);
      AddTerm(basis, lofts.v.cubic[i][j], s);
      if (i == 0 || i == 3 || j == 0 || j == 3) continue;
      Jet2 phi = blend.lambda * basis;
      if (corner) phi.uu = phi.vv = 0.0, phi.uv = 0.5 * basis.uv;  // the mean of the two twists
      AddTerm(phi, lofts.u.cubic[j][i] - lofts.v.cubic[i][j], s);
    }
  }
  return s;
}

Vec3 ShapePosition(const BrownPatch& patch, double u, double v) {
  const Lofts lofts = LoftsOf(patch, SpanAt(patch.breaks_u, u), SpanAt(patch.breaks_v, v));
  double bu[4], bv[4], bn[kMaxRow], bm[kMaxRow];
  const auto local = [](const Loft& loft, double t) {
    return (t - loft.span.t0) / (loft.span.t1 - loft.span.t0);
  };
  AllBernstein(3, u, bu);
  AllBernstein(3, v, bv);
  AllBernstein(lofts.u.degree, local(lofts.u, u), bn);
  AllBernstein(lofts.v.degree, local(lofts.v, v), bm);
  Vec3 s1 = Vec3::Zero(), s2 = Vec3::Zero();
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i <= lofts.u.degree; ++i) s1 += bv[k] * bn[i] * lofts.u.row[k][i];
    for (int j = 0; j <= lofts.v.degree; ++j) s2 += bu[k] * bm[j] * lofts.v.row[k][j];
  }
  const double a = u * (1.0 - u), b = v * (1.0 - v), p = a * a, q = b * b;
  const double lambda = p + q > 0.0 ? p / (p + q) : 0.5;
  return s2 + lambda * (s1 - s2);
}

namespace {

// Bernstein coefficients of t^2 (1-t)^2 on the span, times binomials.
std::array<double, 5> ScaledWeight(const Span& span) {
  const std::vector<double> t = {span.t0, span.t1}, r = {1.0 - span.t0, 1.0 - span.t1};
  const auto product = BernsteinProduct(BernsteinProduct(t, t), BernsteinProduct(r, r));
  std::array<double, 5> scaled;
  for (int k = 0; k <= 4; ++k) {
    scaled[static_cast<std::size_t>(k)] = product[static_cast<std::size_t>(k)] * Binomial(4, k);
  }
  return scaled;
}

// The net of (p S1 + q S2) / (p + q), raised to the degrees n + 4 and m + 4 where it has less.
BernsteinNet NetOn(const Lofts& lofts) {
  const int n = lofts.u.degree, m = lofts.v.degree;
  ScaledBernstein<Vec4> s1(n, 3, Vec4::Zero()), s2(3, m, Vec4::Zero()), net(n + 4, m + 4, Vec4::Zero());
  ScaledBernstein<double> p(4, m + 1, 0.0), q(n + 1, 4, 0.0);
  const auto put = [](const Vec3& x, double factor) { return Vec4(factor * Vec4(x.x(), x.y(), x.z(), 1.0)); };
  // The cubic across the loft at its point `along`, restricted to the span of the other direction.
  const auto across = [](const Loft& loft, int along, const Span& span, Vec3 cubic[4]) {
    for (int k = 0; k < 4; ++k) cubic[k] = loft.row[k][along];
    Restrict(cubic, 3, span);
  };
  Vec3 cubic[4];
  for (int i = 0; i <= n; ++i) {
    across(lofts.u, i, lofts.v.span, cubic);
    for (int k = 0; k < 4; ++k) s1(i, k) = put(cubic[k], Binomial(n, i) * Binomial(3, k));
  }
  for (int j = 0; j <= m; ++j) {
    across(lofts.v, j, lofts.u.span, cubic);
    for (int k = 0; k < 4; ++k) s2(k, j) = put(cubic[k], Binomial(m, j) * Binomial(3, k));
  }
  const auto wu = ScaledWeight(lofts.u.span), wv = ScaledWeight(lofts.v.span);
  for (int k = 0; k <= 4; ++k) {
    for (int l = 0; l <= m + 1; ++l) p(k, l) = wu[static_cast<std::size_t>(k)] * Binomial(m + 1, l);
    for (int l = 0; l <= n + 1; ++l) q(l, k) = wv[static_cast<std::size_t>(k)] * Binomial(n + 1, l);
  }
  s1.MultiplyInto(p, net);
  s2.MultiplyInto(q, net);
  return {n + 4, m + 4, true, net.Unscaled()};
}

}  // namespace

ScaledBernstein<double> NetWeight(const BrownPatch&) {  // p + q
  const auto weight = ScaledWeight({});
  ScaledBernstein<double> sum(4, 4, 0.0);
  for (int k = 0; k <= 4; ++k) {
    for (int l = 0; l <= 4; ++l) {
      sum(k, l) = weight[static_cast<std::size_t>(k)] * Binomial(4, l) +
                  weight[static_cast<std::size_t>(l)] * Binomial(4, k);
    }
  }
  return sum;
}

std::vector<Piece> ShapePieces(const BrownPatch& patch, const RunContext& run) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i <= patch.breaks_u.size(); ++i) {
    const Span u = SpanNumber(patch.breaks_u, i);
    for (std::size_t j = 0; j <= patch.breaks_v.size(); ++j) {
      if (j % 64 == 0 && run.Cancelled()) return pieces;
      const Span v = SpanNumber(patch.breaks_v, j);
      Piece& piece = pieces.emplace_back();
      piece.net = NetOn(LoftsOf(patch, u, v));
      piece.native = NativeRectangle(u.t0, u.t1, v.t0, v.t1);
    }
  }
  return pieces;
}

}  // namespace patchmill::internal
