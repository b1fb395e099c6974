// Loft triangles: three quads with one edge shrunk to a vertex, blended [shapes (17)-(19)].
//
// Each sub-patch S_o (o: its own vertex; its edge runs from e = o+1 to f = o+2; r = u_e + u_f) is
//   S_o = B_0(u_o) C(t) + B_1(u_o) Rail(t) + B_2(u_o) (P_o + d_o(t)/3) + B_3(u_o) P_o,  t = u_f / r.
// With cubic Hermite parts of C and Rail, all three differ from one cubic triangle R only by
//   3 u_o u_e u_f (u_e X + u_f Y)/r,  X = 3 Rail_1 - Rail_0 - 2 b, Y = 3 Rail_2 - Rail_3 - 2 b,
// where b is the inner point of R. The part of a quartic edge beyond its Hermite part adds
//   6 u_e^2 u_f^2 (dC/r + 3 u_o dRail/r^2).
// So S is R plus a sum of blends of these, and nothing cancels near a vertex.
#include "core/math/triangle_bernstein.h"
#include "core/patch/kinds.h"
#include "core/patch/triangle_pieces.h"

namespace patchmill::internal {
namespace {

// One edge with its rail, ends included.
struct Side {
  Vec3 curve[5], rail[5];
};

void ReadSides(const LoftTriangle& patch, Side (&sides)[3]) {
  const int n = patch.degree;
  const auto boundary = [&](int k) -> const Vec3& {
    return patch.points[static_cast<std::size_t>((k + 3 * n) % (3 * n))];
  };
  for (int e = 0; e < 3; ++e) {
    for (int k = 0; k <= n; ++k) sides[e].curve[k] = boundary(e * n + k);
    for (int k = 1; k < n; ++k) {
      sides[e].rail[k] = patch.points[static_cast<std::size_t>(3 * n + e * (n - 1) + k - 1)];
    }
    // A rail starts and ends on the other edge there: a third of that edge's derivative from the vertex.
    const Vec3 &start = boundary(e * n), &end = boundary(e * n + n);
    sides[e].rail[0] = start + n / 3.0 * (boundary(e * n - 1) - start);
    sides[e].rail[n] = end + n / 3.0 * (boundary(e * n + n + 1) - end);
  }
}

// Bezier points of the cubic with the ends and end derivatives of `row`. For n = 4 the rest is excess * t^2
// (1-t)^2.
struct HermiteSplit {
  Vec3 cubic[4];
  Vec3 excess = Vec3::Zero();
};
HermiteSplit Split(const Vec3* row, int n) {
  HermiteSplit s;
  s.cubic[0] = row[0];
  s.cubic[1] = row[0] + n / 3.0 * (row[1] - row[0]);
  s.cubic[2] = row[n] + n / 3.0 * (row[n - 1] - row[n]);
  s.cubic[3] = row[n];
  if (n == 4) s.excess = 6.0 * (row[2] - 0.5 * (s.cubic[1] + s.cubic[2]));
  return s;
}

struct Parts {
  HermiteSplit curve[3], rail[3];
  Vec3 center;  // inner point of R; the mean of the rails' inner points (any point would do)
};
Parts PartsOf(const LoftTriangle& patch) {
  Side sides[3];
  ReadSides(patch, sides);
  Parts parts;
  parts.center = Vec3::Zero();
  for (int e = 0; e < 3; ++e) {
    parts.curve[e] = Split(sides[e].curve, patch.degree);
    parts.rail[e] = Split(sides[e].rail, patch.degree);
    parts.center += (parts.rail[e].cubic[1] + parts.rail[e].cubic[2]) / 6.0;
  }
  return parts;
}

// Second derivatives with respect to the parameters u_e and u_f.
struct SideHessian {
  double ee, ef, ff;
};

// Sets the second derivatives of phi to those of h_ee u_e^2/2 + h_ef u_e u_f + h_ff u_f^2/2.
void SetHessian(const SideHessian& h, const Jet2& e, const Jet2& f, Jet2& phi) {
  const auto& [ee, ef, ff] = h;
  phi.uu = ee * e.u * e.u + 2.0 * ef * e.u * f.u + ff * f.u * f.u;
  phi.uv = ee * e.u * e.v + ef * (e.u * f.v + e.v * f.u) + ff * f.u * f.v;
  phi.vv = ee * e.v * e.v + 2.0 * ef * e.v * f.v + ff * f.v * f.v;
}

}  // namespace

SurfaceJet EvaluateShape(const LoftTriangle& patch, double s, double t) {
  const Parts parts = PartsOf(patch);
  const Jet2 area[3] = {{1.0 - s - t, -1, -1, 0, 0, 0}, Jet2::U(s), Jet2::V(t)};
  SurfaceJet jet;
  // R is the cubic triangle.
  for (int e = 0; e < 3; ++e) {
    const Jet2 &a = area[e], &b = area[(e + 1) % 3];
    AddTerm(a * a * a, parts.curve[e].cubic[0], jet);
    AddTerm(3.0 * (a * a * b), parts.curve[e].cubic[1], jet);
    AddTerm(3.0 * (a * b * b), parts.curve[e].cubic[2], jet);
  }
  AddTerm(6.0 * (area[0] * area[1] * area[2]), parts.center, jet);

  Jet2 weight[3], all = Jet2::Constant(0.0);  // of the sub-patch of edge e
  for (int e = 0; e < 3; ++e) {
    weight[e] = area[e] * area[(e + 1) % 3];
    if (patch.squared) weight[e] = weight[e] * weight[e];
    all = all + weight[e];
  }
  const bool at_vertex = !(all.f > kNothing * (patch.squared ? kNothing : 1.0));
  int vertex = -1;
  for (int i = 0; i < 3; ++i) {
    if (area[(i + 1) % 3].f < kCornerRadius && area[(i + 2) % 3].f < kCornerRadius) vertex = i;
  }
  for (int e = 0; e < 3; ++e) {
    const Jet2 &a = area[e], &b = area[(e + 1) % 3], &o = area[(e + 2) % 3];
    const Jet2 r = a + b;
    if (!(r.f > kNothing)) continue;
    const Jet2 share = at_vertex ? Jet2::Constant(0.0) : weight[e] / all, across = share * (o * (a * b));
    // At a vertex of the edge: pure second derivatives of the edge curve, and half of each edge's twist.
    const bool at_a = vertex == e, at_b = vertex == (e + 1) % 3;
    const auto add = [&](Jet2 phi, double twist_a, double twist_b, double curve, const Vec3& d) {
      if (at_a) {
        SetHessian({0, twist_a, curve}, o, b, phi);
      } else if (at_b) {
        SetHessian({0, twist_b, curve}, o, a, phi);
      } else if (vertex >= 0) {
        phi.uu = phi.uv = phi.vv = 0.0;
      }
      AddTerm(phi, d, jet);
    };
    const auto& rail = parts.rail[e].cubic;
    add(3.0 * (across * (a / r)), 1.5, 0, 0, 3.0 * rail[1] - rail[0] - 2.0 * parts.center);
    add(3.0 * (across * (b / r)), 0, 1.5, 0, 3.0 * rail[2] - rail[3] - 2.0 * parts.center);
    if (patch.degree == 3) continue;
    const Jet2 bump = share * ((a * a) * (b * b)) / r;
    add(bump, 0, 0, 2, parts.curve[e].excess);
    add(3.0 * (bump * o / r), 0, 0, 0, parts.rail[e].excess);
  }
  return jet;
}

Vec3 ShapePosition(const LoftTriangle& patch, double s, double t) { return EvaluateShape(patch, s, t).p; }

// All sub-patches over the common denominator prod_i (1 - u_i)^(n-2) * sum of weights: a rational triangle.
std::vector<Piece> ShapePieces(const LoftTriangle& patch) {
  using Scalar = ScaledTriangle<double>;
  const int n = patch.degree, power = n - 2;
  Side sides[3];
  ReadSides(patch, sides);
  const auto variable = [](int k) {
    Scalar u(1, 0.0);
    u.at(k == 0, k == 1, k == 2) = 1.0;
    return u;
  };
  const auto beside = [&](int vertex) {  // (1 - u_vertex)^(n-2)
    Scalar product(0, 1.0);
    Scalar r = variable((vertex + 1) % 3);
    for (std::size_t k = 0; k < 3; ++k) r.c[k] += variable((vertex + 2) % 3).c[k];
    for (int k = 0; k < power; ++k) product = product * r;
    return product;
  };
  ScaledTriangle<Vec4> net((patch.squared ? 4 : 2) + n + 1 + 2 * power, Vec4::Zero());
  for (int e = 0; e < 3; ++e) {
    const int f = (e + 1) % 3, o = (e + 2) % 3;
    // (1 - u_o)^(n-2) S_o has degree n + 1: r C + 3 u_o Rail + r^(n-2) u_o^2 (3 (..) + u_o P_o), with C and
    // Rail as forms of u_e, u_f.
    ScaledTriangle<Vec4> own(n + 1, Vec4::Zero());
    const auto add = [&](int ke, int kf, int ko, double factor, const Vec3& p) {
      int k[3] = {};
      k[e] = ke, k[f] = kf, k[o] = ko;
      own.at(k[0], k[1], k[2]) += factor * Vec4(p.x(), p.y(), p.z(), 1.0);
    };
    for (int k = 0; k <= n; ++k) {
      add(n - k + 1, k, 0, Binomial(n, k), sides[e].curve[k]);
      add(n - k, k + 1, 0, Binomial(n, k), sides[e].curve[k]);
      add(n - k, k, 1, 3.0 * Binomial(n, k), sides[e].rail[k]);
    }
    const Vec3& apex = sides[o].curve[0];
    const Vec3 to_f = apex + n / 3.0 * (sides[f].curve[n - 1] - apex);  // edge f runs from f to o
    const Vec3 to_e = apex + n / 3.0 * (sides[o].curve[1] - apex);      // edge o runs from o to e
    for (int k = 0; k <= power; ++k) {
      add(power - k + 1, k, 2, 3.0 * Binomial(power, k), to_e);
      add(power - k, k + 1, 2, 3.0 * Binomial(power, k), to_f);
      add(power - k, k, 3, Binomial(power, k), apex);
    }
    Scalar weight = variable(e) * variable(f);
    if (patch.squared) weight = weight * weight;
    own.MultiplyInto(weight * beside(e) * beside(f), net);
  }
  return TrianglePieces(net.n, net.Unscaled(), true);
}

}  // namespace patchmill::internal
