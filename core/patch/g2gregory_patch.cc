// G2-Gregory patches: the net with the block entries P_ij0 of v=0, v=1, plus at each block entry
//   lambda(u,v) B_i(u) B_j(v) (P_ij1 - P_ij0),  lambda = b^2/(a^2 + b^2),
// where a and b are the distances along u and v from the block's corner [shapes (21)].
#include "core/math/tensor_bernstein.h"
#include "core/patch/bulge.h"
#include "core/patch/kinds.h"
#include "core/patch/tensor_kernel.h"

namespace patchmill::internal {
namespace {

// Index in the net of block entry 0..3: one of 1, 2, n-2, n-1.
int BlockIndex(int n, int block) { return block < 2 ? 1 + block : n - 4 + block; }

Jet2 Ratio(bool end_u, bool end_v, double u, double v) {
  const double a = end_u ? 1.0 - u : u, b = end_v ? 1.0 - v : v;
  if (!(a + b > kNothing)) return Jet2::Constant(0.5);
  const Jet2 p{a * a, end_u ? -2.0 * a : 2.0 * a, 0.0, 2.0, 0.0, 0.0};
  const Jet2 q{b * b, 0.0, end_v ? -2.0 * b : 2.0 * b, 0.0, 0.0, 2.0};
  return q / (p + q);
}

template <class Visit>  // visit(a, b, i, j, P_ij0, P_ij1)
void ForBlocks(const G2GregoryPatch& patch, const Visit& visit) {
  const int n = patch.degree;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      const int i = BlockIndex(n, a), j = BlockIndex(n, b);
      visit(a, b, i, j, patch.points[static_cast<std::size_t>(i * (n + 1) + j)],
            patch.points[static_cast<std::size_t>((n + 1) * (n + 1) + 4 * a + b)]);
    }
  }
}

}  // namespace

SurfaceJet EvaluateShape(const G2GregoryPatch& patch, double u, double v) {
  const int n = patch.degree;
  BasisJet bu, bv;
  AllBernsteinJet(n, u, bu);
  AllBernsteinJet(n, v, bv);
  const auto basis = [&](int i, int j) {
    return Jet2{bu.f[i] * bv.f[j],  bu.d[i] * bv.f[j], bu.f[i] * bv.d[j],
                bu.dd[i] * bv.f[j], bu.d[i] * bv.d[j], bu.f[i] * bv.dd[j]};
  };
  SurfaceJet s;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      AddTerm(basis(i, j), patch.points[static_cast<std::size_t>(i * (n + 1) + j)], s);
    }
  }
  Jet2 ratio[2][2];
  for (const bool eu : {false, true}) {
    for (const bool ev : {false, true}) ratio[eu][ev] = Ratio(eu, ev, u, v);
  }
  ForBlocks(patch, [&](int a, int b, int i, int j, const Vec3& first, const Vec3& second) {
    const Jet2 own = basis(i, j);
    Jet2 phi = ratio[a >= 2][b >= 2] * own;
    const double du = a >= 2 ? 1.0 - u : u, dv = b >= 2 ? 1.0 - v : v;
    if (du < kCornerRadius && dv < kCornerRadius) {  // S_uu, S_vv of the boundary curves, mean twist
      phi.uu = phi.vv = 0.0;
      phi.uv = 0.5 * own.uv;
    }
    AddTerm(phi, second - first, s);
  });
  return s;
}

Vec3 ShapePosition(const G2GregoryPatch& patch, double u, double v) {
  const int n = patch.degree;
  double bu[kMaxBasisDegree + 1], bv[kMaxBasisDegree + 1];
  AllBernstein(n, u, bu);
  AllBernstein(n, v, bv);
  Vec3 s = Vec3::Zero();
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) s += bu[i] * bv[j] * patch.points[static_cast<std::size_t>(i * (n + 1) + j)];
  }
  ForBlocks(patch, [&](int a, int b, int i, int j, const Vec3& first, const Vec3& second) {
    const double du = a >= 2 ? 1.0 - u : u, dv = b >= 2 ? 1.0 - v : v, sum = du * du + dv * dv;
    s += (sum > 0.0 ? dv * dv / sum : 0.5) * bu[i] * bv[j] * (second - first);
  });
  return s;
}

namespace {

using Scalar = ScaledBernstein<double>;

// Square of the distance along u (along_u) or v from the end 0 or 1, in bidegree (2,2).
Scalar Square(bool along_u, bool end) {
  Scalar form(2, 2, 0.0);
  for (int k = 0; k < 3; ++k) (along_u ? form(end ? 0 : 2, k) : form(k, end ? 0 : 2)) = Binomial(2, k);
  return form;
}

// Product of the sums a^2 + b^2 of all corners but one.
Scalar Denominators(int without) {
  Scalar product(0, 0, 1.0);
  for (int corner = 0; corner < 4; ++corner) {
    if (corner == without) continue;
    Scalar sum = Square(true, corner / 2 == 1);
    const Scalar other = Square(false, corner % 2 == 1);
    for (std::size_t k = 0; k < sum.c.size(); ++k) sum.c[k] += other.c[k];
    Scalar next(product.m + 2, product.n + 2, 0.0);
    product.MultiplyInto(sum, next);
    product = std::move(next);
  }
  return product;
}

}  // namespace

Scalar NetWeight(const G2GregoryPatch&) { return Denominators(-1); }

// The net is multiplied by the product of the four corner sums a^2 + b^2: degree n + 8 each way.
std::vector<Piece> ShapePieces(const G2GregoryPatch& patch) {
  const int n = patch.degree;
  const auto put = [n](int i, int j, const Vec3& p) {
    return Vec4(Binomial(n, i) * Binomial(n, j) * Vec4(p.x(), p.y(), p.z(), 1.0));
  };
  ScaledBernstein<Vec4> regular(n, n, Vec4::Zero()), net(n + 8, n + 8, Vec4::Zero());
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      regular(i, j) = put(i, j, patch.points[static_cast<std::size_t>(i * (n + 1) + j)]);
    }
  }
  ForBlocks(patch, [&](int, int, int i, int j, const Vec3&, const Vec3&) { regular(i, j).setZero(); });
  regular.MultiplyInto(Denominators(-1), net);
  for (int corner = 0; corner < 4; ++corner) {
    ScaledBernstein<Vec4> first(n, n, Vec4::Zero()), second(n, n, Vec4::Zero());
    ForBlocks(patch, [&](int a, int b, int i, int j, const Vec3& p0, const Vec3& p1) {
      if (2 * (a >= 2) + (b >= 2) != corner) return;
      first(i, j) = put(i, j, p0);
      second(i, j) = put(i, j, p1);
    });
    const Scalar others = Denominators(corner);
    for (const bool along_u : {true, false}) {
      Scalar weight(others.m + 2, others.n + 2, 0.0);
      others.MultiplyInto(Square(along_u, along_u ? corner / 2 == 1 : corner % 2 == 1), weight);
      (along_u ? first : second).MultiplyInto(weight, net);
    }
  }
  std::vector<Piece> pieces(1);
  pieces[0].net = {n + 8, n + 8, true, net.Unscaled()};
  pieces[0].native = NativeRectangle(0, 1, 0, 1);
  return pieces;
}

}  // namespace patchmill::internal
