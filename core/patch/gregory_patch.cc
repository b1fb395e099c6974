// Bicubic Gregory quads with corner and edge blend.
//
// Both are the bicubic net that uses the second point of each inner pair, plus, at each corner c,
//   lambda_c(u,v) B_i(u) B_j(v) D_c,   D_c = first point - second point of the pair, (i,j) in {1,2}^2,
// with lambda_c = a/(a+b), a and b the distances from the corner along u and v (kCorner), or
// lambda = p/(p+q), p = u(1-u), q = v(1-v), at all four corners (kEdge, [shapes (7)]). The sum of scalar jets
// keeps the evaluation short and free of cancellation.
#include "core/math/jet2.h"
#include "core/math/tensor_bernstein.h"
#include "core/patch/bulge.h"
#include "core/patch/gregory_layout.h"
#include "core/patch/kinds.h"
#include "core/patch/tensor_kernel.h"

namespace patchmill::internal {
namespace {

// The blend of [shapes (7)]. At a corner it is 1/2 and flat; its factor vanishes there to second order.
Jet2 EdgeRatio(double u, double v) {
  const Jet2 p{u * (1.0 - u), 1.0 - 2.0 * u, 0.0, -2.0, 0.0, 0.0};
  const Jet2 q{v * (1.0 - v), 0.0, 1.0 - 2.0 * v, 0.0, 0.0, -2.0};
  const Jet2 sum = p + q;
  return sum.f > kNothing ? p / sum : Jet2::Constant(0.5);
}

// a/(a+b), with a and b the distances from the corner along u and v. Derivatives are in closed form.
Jet2 CornerRatio(const GregoryCorner& c, double u, double v) {
  const double a = c.i == 1 ? u : 1.0 - u, b = c.j == 1 ? v : 1.0 - v;
  if (!(a + b > kNothing)) return Jet2::Constant(0.5);
  const double su = c.i == 1 ? 1.0 : -1.0, sv = c.j == 1 ? 1.0 : -1.0;
  const double r = 1.0 / (a + b), r2 = r * r, r3 = r2 * r;
  return {a * r, su * b * r2, -sv * a * r2, -2.0 * b * r3, su * sv * (a - b) * r3, 2.0 * a * r3};
}

bool NearCorner(const GregoryCorner& c, double u, double v) {
  return (c.i == 1 ? u : 1.0 - u) < kCornerRadius && (c.j == 1 ? v : 1.0 - v) < kCornerRadius;
}

template <GregoryPatch::Blend kBlend>
SurfaceJet EvaluateBlend(const GregoryPatch& patch, double u, double v) {
  BasisJet bu, bv;
  AllBernsteinJet(3, u, bu);
  AllBernsteinJet(3, v, bv);
  // Four lanes are faster than three; the last one is unused.
  Vec4 points[20];
  for (int k = 0; k < 20; ++k) points[k] << patch.points[static_cast<std::size_t>(k)], 0.0;
  const auto point = [&](int number) -> const Vec4& { return points[number]; };
  HomogeneousJet h = TensorJet(3, 3, bu, bv, [&](int i, int j) { return point(kGregoryNet[4 * i + j]); });
  Jet2 ratio;
  if (kBlend == GregoryPatch::Blend::kEdge) ratio = EdgeRatio(u, v);
#pragma GCC unroll 4
  for (int k = 0; k < 4; ++k) {
    const GregoryCorner& c = kGregoryCorners[k];
    if (kBlend == GregoryPatch::Blend::kCorner) ratio = CornerRatio(c, u, v);
    const Jet2 basis{bu.f[c.i] * bv.f[c.j],  bu.d[c.i] * bv.f[c.j], bu.f[c.i] * bv.d[c.j],
                     bu.dd[c.i] * bv.f[c.j], bu.d[c.i] * bv.d[c.j], bu.f[c.i] * bv.dd[c.j]};
    Jet2 phi = ratio * basis;
    if (NearCorner(c, u, v)) {  // S_uu, S_vv of the boundary curves, S_uv the mean of the two twists
      phi.uu = phi.vv = 0.0;
      phi.uv = 0.5 * basis.uv;
    }
    const Vec4 d = point(c.first) - point(c.second);
    h.p += phi.f * d;
    h.du += phi.u * d;
    h.dv += phi.v * d;
    h.duu += phi.uu * d;
    h.duv += phi.uv * d;
    h.dvv += phi.vv * d;
  }
  return PolynomialJet(h);
}

}  // namespace

SurfaceJet EvaluateShape(const GregoryPatch& patch, double u, double v) {
  using enum GregoryPatch::Blend;
  return patch.blend == kCorner ? EvaluateBlend<kCorner>(patch, u, v) : EvaluateBlend<kEdge>(patch, u, v);
}

Vec3 ShapePosition(const GregoryPatch& patch, double u, double v) {
  double bu[kMaxBasisDegree + 1], bv[kMaxBasisDegree + 1];
  AllBernstein(3, u, bu);
  AllBernstein(3, v, bv);
  Vec3 s = Vec3::Zero();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j)
      s += bu[i] * bv[j] * patch.points[static_cast<std::size_t>(kGregoryNet[4 * i + j])];
  }
  const double p = u * (1.0 - u), q = v * (1.0 - v);
  for (const GregoryCorner& c : kGregoryCorners) {
    double a = p, b = q;
    if (patch.blend == GregoryPatch::Blend::kCorner) {
      a = c.i == 1 ? u : 1.0 - u;
      b = c.j == 1 ? v : 1.0 - v;
    }
    const double ratio = a + b > 0.0 ? a / (a + b) : 0.5;
    s += ratio * bu[c.i] * bv[c.j] *
         (patch.points[static_cast<std::size_t>(c.first)] - patch.points[static_cast<std::size_t>(c.second)]);
  }
  return s;
}

namespace {

using Scalar = ScaledBernstein<double>;
using Points = ScaledBernstein<Vec4>;

Scalar Product(const Scalar& a, const Scalar& b) {
  Scalar c(a.m + b.m, a.n + b.n, 0.0);
  a.MultiplyInto(b, c);
  return c;
}

Scalar Linear(double c00, double c01, double c10, double c11) {  // values at (0,0) (0,1) (1,0) (1,1)
  Scalar s(1, 1, 0.0);
  s(0, 0) = c00;
  s(0, 1) = c01;
  s(1, 0) = c10;
  s(1, 1) = c11;
  return s;
}

// The bicubic with the first or second inner points, or with none of them; homogeneous with w = 1, scaled.
Points Bicubic(const GregoryPatch& patch, bool inner, bool first) {
  Points net(3, 3, Vec4::Zero());
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      int number = kGregoryNet[4 * i + j];
      for (const GregoryCorner& c : kGregoryCorners) {
        if (first && c.i == i && c.j == j) number = c.first;
      }
      const bool is_inner = (i == 1 || i == 2) && (j == 1 || j == 2);
      if (is_inner && !inner) continue;
      const Vec3& p = patch.points[static_cast<std::size_t>(number)];
      net(i, j) = Vec4(p.x(), p.y(), p.z(), 1.0) * (Binomial(3, i) * Binomial(3, j));
    }
  }
  return net;
}

Scalar DistanceSum(const GregoryCorner& c) {
  Scalar sum = c.i == 1 ? Linear(0, 0, 1, 1) : Linear(1, 1, 0, 0);          // u, 1-u
  const Scalar other = c.j == 1 ? Linear(0, 1, 0, 1) : Linear(1, 0, 1, 0);  // v, 1-v
  for (std::size_t k = 0; k < 4; ++k) sum.c[k] += other.c[k];
  return sum;
}

// The net of (p S1 + q S2) / (p + q), raised to bidegree (5,5).
Points EdgeNet(const GregoryPatch& patch) {
  Scalar p(2, 2, 0.0), q(2, 2, 0.0);  // scaled: u(1-u) (1-v+v)^2 and likewise
  for (int k = 0; k < 3; ++k) p(1, k) = q(k, 1) = Binomial(2, k);
  Points net(5, 5, Vec4::Zero());
  Bicubic(patch, true, true).MultiplyInto(p, net);
  Bicubic(patch, true, false).MultiplyInto(q, net);
  return net;
}

// The net multiplied by the product of the four corner denominators: bidegree (7,7).
Points CornerNet(const GregoryPatch& patch) {
  const Scalar from_u[2] = {Linear(0, 0, 1, 1), Linear(1, 1, 0, 0)};  // u, 1-u
  const Scalar from_v[2] = {Linear(0, 1, 0, 1), Linear(1, 0, 1, 0)};  // v, 1-v
  // Product of the denominators of all corners except `without`.
  const auto denominators = [&](int without) {
    Scalar w(0, 0, 1.0);
    for (int k = 0; k < 4; ++k) {
      if (k != without) w = Product(w, DistanceSum(kGregoryCorners[k]));
    }
    return w;
  };
  Points net(7, 7, Vec4::Zero());
  Bicubic(patch, false, false).MultiplyInto(denominators(-1), net);
  for (int k = 0; k < 4; ++k) {
    const GregoryCorner& c = kGregoryCorners[k];
    const Scalar others = denominators(k);
    const auto add = [&](int number, const Scalar& distance) {
      Points single(3, 3, Vec4::Zero());
      const Vec3& p = patch.points[static_cast<std::size_t>(number)];
      single(c.i, c.j) = Vec4(p.x(), p.y(), p.z(), 1.0) * (Binomial(3, c.i) * Binomial(3, c.j));
      single.MultiplyInto(Product(distance, others), net);
    };
    add(c.first, from_u[c.i - 1]);
    add(c.second, from_v[c.j - 1]);
  }
  return net;
}

}  // namespace

Scalar NetWeight(const GregoryPatch& patch) {
  if (patch.blend == GregoryPatch::Blend::kEdge) {  // p + q
    Scalar sum(2, 2, 0.0);
    for (int k = 0; k < 3; ++k) sum(1, k) += Binomial(2, k), sum(k, 1) += Binomial(2, k);
    return sum;
  }
  Scalar product(0, 0, 1.0);
  for (const GregoryCorner& c : kGregoryCorners) product = Product(product, DistanceSum(c));
  return product;
}

std::vector<Piece> ShapePieces(const GregoryPatch& patch) {
  const Points form = patch.blend == GregoryPatch::Blend::kEdge ? EdgeNet(patch) : CornerNet(patch);
  std::vector<Piece> pieces(1);
  Piece& piece = pieces[0];
  piece.net.degree_u = form.m;
  piece.net.degree_v = form.n;
  piece.net.rational = true;
  piece.net.points = form.Unscaled();
  piece.native = NativeRectangle(0, 1, 0, 1);
  return pieces;
}

}  // namespace patchmill::internal
