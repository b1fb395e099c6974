// Quartic Gregory triangles: the quartic of the mean inner points plus, at each corner i with the pair F+,
// F-,
//   12 u_i^2 u_j u_k * ratio * (F+ - F-)/2,   j = i+1, k = i+2,
// where ratio = (u_j - u_k)/(u_j + u_k) (kCorner) or u_i (u_j - u_k)/(u1 u2 + u2 u3 + u3 u1) (kEdge).
#include "core/math/triangle_bernstein.h"
#include "core/patch/kinds.h"
#include "core/patch/triangle_pieces.h"

namespace patchmill::internal {
namespace {

// kQuartic[k]: number of quartic point k, row after row. -1 - i stands for the inner point of corner i.
constexpr int kQuartic[15] = {0, 1, 15, 7, 5, 2, -1, -2, 6, 17, -3, 16, 11, 12, 10};

const Vec3& Plus(const GregoryTriangle& g, int corner) {
  return g.points[static_cast<std::size_t>(5 * corner + 3)];
}
const Vec3& Minus(const GregoryTriangle& g, int corner) {
  return g.points[static_cast<std::size_t>(5 * corner + 4)];
}

// The quartic with these inner points at the three corners.
BezierTriangle Quartic(const GregoryTriangle& g, const Vec3 (&inner)[3]) {
  BezierTriangle quartic;
  quartic.degree = 4;
  quartic.points.reserve(15);
  for (const int k : kQuartic) {
    quartic.points.push_back(k < 0 ? inner[-1 - k] : g.points[static_cast<std::size_t>(k)]);
  }
  return quartic;
}

BezierTriangle MeanQuartic(const GregoryTriangle& g) {
  const Vec3 inner[3] = {0.5 * (Plus(g, 0) + Minus(g, 0)), 0.5 * (Plus(g, 1) + Minus(g, 1)),
                         0.5 * (Plus(g, 2) + Minus(g, 2))};
  return Quartic(g, inner);
}

}  // namespace

SurfaceJet EvaluateShape(const GregoryTriangle& patch, double s, double t) {
  SurfaceJet jet = EvaluateShape(MeanQuartic(patch), s, t);
  const Jet2 area[3] = {{1.0 - s - t, -1, -1, 0, 0, 0}, Jet2::U(s), Jet2::V(t)};
  const Jet2 all = area[0] * area[1] + area[1] * area[2] + area[2] * area[0];
  for (int i = 0; i < 3; ++i) {
    const Jet2 &u = area[i], &a = area[(i + 1) % 3], &b = area[(i + 2) % 3];
    const Jet2 below = patch.blend == GregoryPatch::Blend::kCorner ? a + b : all;
    if (!(below.f > kNothing)) continue;
    const Jet2 above = patch.blend == GregoryPatch::Blend::kCorner ? a - b : u * (a - b);
    Jet2 phi = 6.0 * (u * u * a * b * (above / below));
    // At its own corner the term gets no second derivatives, which leaves the mean twist.
    if (a.f < kCornerRadius && b.f < kCornerRadius) phi.uu = phi.uv = phi.vv = 0.0;
    AddTerm(phi, Plus(patch, i) - Minus(patch, i), jet);
  }
  return jet;
}

Vec3 ShapePosition(const GregoryTriangle& patch, double s, double t) { return EvaluateShape(patch, s, t).p; }

std::vector<Piece> ShapePieces(const GregoryTriangle& patch) {
  using Scalar = ScaledTriangle<double>;
  using Points = ScaledTriangle<Vec4>;
  const auto homogeneous = [](const BezierTriangle& quartic) {
    Points form(4, Vec4::Zero());
    for (int r = 0, k = 0; r <= 4; ++r) {
      for (int b = 0; b <= 4 - r; ++b, ++k) {
        const Vec3& p = quartic.points[static_cast<std::size_t>(k)];
        form.at(4 - r - b, b, r) = Multinomial(4 - r - b, b, r) * Vec4(p.x(), p.y(), p.z(), 1.0);
      }
    }
    return form;
  };
  const auto variable = [](int k) {
    Scalar u(1, 0.0);
    u.at(k == 0, k == 1, k == 2) = 1.0;
    return u;
  };
  const bool edges = patch.blend == GregoryPatch::Blend::kEdge;
  Points net(edges ? 6 : 7, Vec4::Zero());
  if (edges) {
    // Sub-patch of edge e, from corner e to e+1, with weight u_e u_(e+1).
    for (int e = 0; e < 3; ++e) {
      const int next = (e + 1) % 3, third = (e + 2) % 3;
      Vec3 inner[3];
      inner[e] = Plus(patch, e);
      inner[next] = Minus(patch, next);
      inner[third] = 0.5 * (Plus(patch, third) + Minus(patch, third));
      homogeneous(Quartic(patch, inner)).MultiplyInto(variable(e) * variable(next), net);
    }
  } else {
    // Times (u1+u2)(u2+u0)(u0+u1); the inner points of corner i keep u_j or u_k in place of u_j + u_k.
    const auto sum = [&](int a, int b) {
      Scalar both = variable(a);
      for (std::size_t k = 0; k < 3; ++k) both.c[k] += variable(b).c[k];
      return both;
    };
    Points border = homogeneous(MeanQuartic(patch));
    border.at(2, 1, 1) = border.at(1, 2, 1) = border.at(1, 1, 2) = Vec4::Zero();
    border.MultiplyInto(sum(1, 2) * sum(2, 0) * sum(0, 1), net);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const Scalar others = sum(i, j) * sum(i, k);
      for (const auto& [point, with] : {std::pair(Plus(patch, i), j), std::pair(Minus(patch, i), k)}) {
        Points single(4, Vec4::Zero());
        single.at(1 + (i == 0), 1 + (i == 1), 1 + (i == 2)) =
            12.0 * Vec4(point.x(), point.y(), point.z(), 1.0);
        single.MultiplyInto(variable(with) * others, net);
      }
    }
  }
  return TrianglePieces(net.n, net.Unscaled(), true);
}

}  // namespace patchmill::internal
