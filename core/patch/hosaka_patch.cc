// Hosaka's blended boundary patch: evaluation by jets, exact polynomial pieces between the breaks.
//
// With R1(u), R3(u), R2(v), R4(v) the edge curves v=0, v=1, u=0, u=1 relative to their own starts, origin at
// corner (0,0) and Q = R1(1) - R3(1):
//   S = R1 + (R3 - R1) F + R2 + (R4 - R2) G + Q F G + S0,
//   F = f2(v) + (f4(v) - f2(v)) f6(u),  G = f1(u) + (f3(u) - f1(u)) f5(v)      [shapes (23), (24), (28)].
#include <algorithm>

#include "core/math/tensor_bernstein.h"
#include "core/patch/bulge.h"
#include "core/patch/kinds.h"

namespace patchmill::internal {
namespace {

struct Edges {
  int n = 0;
  std::vector<Vec3> r1, r3, r2, r4;  // Bezier points relative to their own starts
  Vec3 origin, q;
  const Vec3* inner = nullptr;  // corner + s_ij
};

Edges EdgesOf(const HosakaPatch& patch) {
  Edges e;
  const int n = e.n = patch.degree;
  const Vec3* next = patch.points.data();
  const auto read = [&](std::vector<Vec3>& row, int count) { row.assign(next, next + count), next += count; };
  read(e.r1, n + 1);
  read(e.r3, n + 1);
  const Vec3 p00 = e.r1.front(), p10 = e.r1.back(), p01 = e.r3.front(), p11 = e.r3.back();
  read(e.r2, n - 1);
  read(e.r4, n - 1);
  e.r2.insert(e.r2.begin(), p00), e.r2.push_back(p01);
  e.r4.insert(e.r4.begin(), p10), e.r4.push_back(p11);
  for (std::vector<Vec3>* row : {&e.r1, &e.r3, &e.r2, &e.r4}) {
    const Vec3 start = row->front();
    for (Vec3& p : *row) p -= start;
  }
  e.origin = p00;
  e.q = (p10 - p00) - (p11 - p01);
  e.inner = next;
  return e;
}

// A smoothstep between two breaks: f = low + (high - low) x^2 (3 - 2x), x = (t - begin)/(end - begin).
struct Stretch {
  double begin = 0.0, end = 1.0, low = 0.0, high = 1.0;
};
Stretch StretchAt(const std::vector<HosakaPatch::Break>& breaks, double t) {
  Stretch s;
  for (const auto& b : breaks) {
    if (b.at <= t) {
      s.begin = b.at, s.low = b.value;
    } else {
      s.end = b.at, s.high = b.value;
      break;
    }
  }
  return s;
}

struct Jet1 {
  double f = 0, d = 0, dd = 0;
};
Jet1 BlendAt(const HosakaPatch& patch, const std::vector<HosakaPatch::Break>* breaks, double t) {
  if (patch.blend == HosakaPatch::Blend::kLinear) return {t, 1.0, 0.0};
  const Stretch s = breaks == nullptr ? Stretch{} : StretchAt(*breaks, t);
  const double length = s.end - s.begin, rise = s.high - s.low, x = (t - s.begin) / length;
  return {s.low + rise * x * x * (3.0 - 2.0 * x), rise * 6.0 * x * (1.0 - x) / length,
          rise * (6.0 - 12.0 * x) / (length * length)};
}
Jet2 OfU(const Jet1& j) { return {j.f, j.d, 0, j.dd, 0, 0}; }
Jet2 OfV(const Jet1& j) { return {j.f, 0, j.d, 0, 0, j.dd}; }

}  // namespace

SurfaceJet EvaluateShape(const HosakaPatch& patch, double u, double v) {
  const Edges e = EdgesOf(patch);
  const auto& b = patch.breaks;
  const Jet2 f2 = OfV(BlendAt(patch, &b[1], v)), f4 = OfV(BlendAt(patch, &b[3], v));
  const Jet2 f1 = OfU(BlendAt(patch, &b[0], u)), f3 = OfU(BlendAt(patch, &b[2], u));
  const Jet2 f = f2 + (f4 - f2) * OfU(BlendAt(patch, nullptr, u));
  const Jet2 g = f1 + (f3 - f1) * OfV(BlendAt(patch, nullptr, v));
  const Jet2 one = Jet2::Constant(1.0);
  BasisJet bu, bv;
  AllBernsteinJet(e.n, u, bu);
  AllBernsteinJet(e.n, v, bv);
  SurfaceJet s;
  s.p = e.origin;
  for (int k = 0; k <= e.n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Jet2 at_u = OfU({bu.f[k], bu.d[k], bu.dd[k]}), at_v = OfV({bv.f[k], bv.d[k], bv.dd[k]});
    AddTerm(at_u * (one - f), e.r1[i], s);
    AddTerm(at_u * f, e.r3[i], s);
    AddTerm(at_v * (one - g), e.r2[i], s);
    AddTerm(at_v * g, e.r4[i], s);
  }
  AddTerm(f * g, e.q, s);
  if (patch.inner_u >= 0) {
    const Jet2 x = Jet2::U(u), y = Jet2::V(v);
    const Jet2 zero_outside = x * (one - x) * (y * (one - y));
    Jet2 row = patch.inner_order == 2 ? zero_outside * zero_outside : zero_outside;
    const Vec3* inner = e.inner;
    for (int i = 0; i <= patch.inner_u; ++i, row = row * x) {
      Jet2 term = row;
      for (int j = 0; j <= patch.inner_v; ++j, term = term * y) AddTerm(term, *inner++ - e.origin, s);
    }
  }
  return s;
}

Vec3 ShapePosition(const HosakaPatch& patch, double u, double v) { return EvaluateShape(patch, u, v).p; }

namespace {

using Scalar = ScaledBernstein<double>;
using Vectors = ScaledBernstein<Vec3>;

// Bernstein coefficients of one variable as a tensor form.
template <class T>
ScaledBernstein<T> Along(bool u, std::vector<T> c, const T& zero) {
  const int n = static_cast<int>(c.size()) - 1;
  ScaledBernstein<T> form(u ? n : 0, u ? 0 : n, zero);
  for (int k = 0; k <= n; ++k)
    form.c[static_cast<std::size_t>(k)] = Binomial(n, k) * c[static_cast<std::size_t>(k)];
  return form;
}

// The coefficients of the part [t0,t1] of a curve.
template <class T>
std::vector<T> PartOf(std::vector<T> c, double t0, double t1) {
  const int n = static_cast<int>(c.size()) - 1;
  if (t0 > 0.0) KeepRight(c.data(), n, 1, t0);
  if (t1 < 1.0) KeepLeft(c.data(), n, 1, (t1 - t0) / (1.0 - t0));
  return c;
}

template <class T>
ScaledBernstein<T> Times(const ScaledBernstein<T>& a, const Scalar& b, const T& zero) {
  ScaledBernstein<T> product(a.m + b.m, a.n + b.n, zero);
  a.MultiplyInto(b, product);
  return product;
}

// to += factor * a, raised to the degrees of `to`.
template <class T>
void AddInto(const ScaledBernstein<T>& a, double factor, ScaledBernstein<T>& to) {
  Scalar ones(to.m - a.m, to.n - a.n, 0.0);
  for (int i = 0; i <= ones.m; ++i) {
    for (int j = 0; j <= ones.n; ++j) ones(i, j) = factor * Binomial(ones.m, i) * Binomial(ones.n, j);
  }
  a.MultiplyInto(ones, to);
}

std::vector<double> BreakParameters(const std::vector<HosakaPatch::Break>& a,
                                    const std::vector<HosakaPatch::Break>& b) {
  std::vector<double> at = {0.0, 1.0};
  for (const auto* list : {&a, &b}) {
    for (const auto& x : *list) at.push_back(x.at);
  }
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  return at;
}

// The Bernstein net of the patch on one rectangle between breaks.
BernsteinNet NetOf(const HosakaPatch& patch, const Edges& e, const ParameterBox& box) {
  const double u0 = box.u0, u1 = box.u1, v0 = box.v0, v1 = box.v1;
  const auto blend = [&](bool along_u, const std::vector<HosakaPatch::Break>* breaks) {
    const double t0 = along_u ? u0 : v0, t1 = along_u ? u1 : v1;
    if (patch.blend == HosakaPatch::Blend::kLinear) return Along<double>(along_u, {t0, t1}, 0.0);
    const Stretch s = breaks == nullptr ? Stretch{} : StretchAt(*breaks, 0.5 * (t0 + t1));
    const double length = s.end - s.begin;
    return Along<double>(
        along_u,
        PartOf<double>({s.low, s.low, s.high, s.high}, (t0 - s.begin) / length, (t1 - s.begin) / length),
        0.0);
  };
  const auto mix = [](const Scalar& low, const Scalar& high,
                      const Scalar& across) {  // low + (high - low) across
    Scalar difference(low.m, low.n, 0.0);
    for (std::size_t k = 0; k < low.c.size(); ++k) difference.c[k] = high.c[k] - low.c[k];
    Scalar sum = Times(difference, across, 0.0);
    AddInto(low, 1.0, sum);
    return sum;
  };
  const auto& b = patch.breaks;
  const Scalar f = mix(blend(false, &b[1]), blend(false, &b[3]), blend(true, nullptr));
  const Scalar g = mix(blend(true, &b[0]), blend(true, &b[2]), blend(false, nullptr));
  const int order = patch.inner_order, highest = std::max(e.n + f.m, f.m + g.m);
  const int inner_u = patch.inner_u < 0 ? 0 : patch.inner_u + 2 * order;
  const int inner_v = patch.inner_v < 0 ? 0 : patch.inner_v + 2 * order;
  const Vec3 zero = Vec3::Zero();
  Vectors sum(std::max(highest, inner_u), std::max(highest, inner_v), zero);
  const auto add_edges = [&](bool along_u, const std::vector<Vec3>& low, const std::vector<Vec3>& high,
                             const Scalar& across) {
    std::vector<Vec3> difference = high;
    for (std::size_t k = 0; k < low.size(); ++k) difference[k] -= low[k];
    const double t0 = along_u ? u0 : v0, t1 = along_u ? u1 : v1;
    AddInto(Along<Vec3>(along_u, PartOf(low, t0, t1), zero), 1.0, sum);
    AddInto(Times(Along<Vec3>(along_u, PartOf(difference, t0, t1), zero), across, zero), 1.0, sum);
  };
  add_edges(true, e.r1, e.r3, f);
  add_edges(false, e.r2, e.r4, g);
  Vectors constant(0, 0, e.q);
  AddInto(Times(constant, Times(f, g, 0.0), zero), 1.0, sum);
  constant(0, 0) = e.origin;
  AddInto(constant, 1.0, sum);
  if (patch.inner_u >= 0) {
    const auto power = [&](bool along_u, int k) {  // t^(order + k) (1-t)^order on the part
      const double t0 = along_u ? u0 : v0, t1 = along_u ? u1 : v1;
      std::vector<double> c = {1.0};
      for (int i = 0; i < order + k; ++i) c = BernsteinProduct(c, {t0, t1});
      for (int i = 0; i < order; ++i) c = BernsteinProduct(c, {1.0 - t0, 1.0 - t1});
      return Along<double>(along_u, std::move(c), 0.0);
    };
    const Vec3* inner = e.inner;
    for (int i = 0; i <= patch.inner_u; ++i) {
      for (int j = 0; j <= patch.inner_v; ++j) {
        constant(0, 0) = *inner++ - e.origin;
        AddInto(Times(constant, Times(power(true, i), power(false, j), 0.0), zero), 1.0, sum);
      }
    }
  }
  BernsteinNet net{sum.m, sum.n, false, {}};
  for (const Vec3& p : sum.Unscaled()) net.points.emplace_back(p.x(), p.y(), p.z(), 1.0);
  return net;
}

}  // namespace

Scalar NetWeight(const HosakaPatch&) { return {0, 0, 1.0}; }

std::vector<Piece> ShapePieces(const HosakaPatch& patch) {
  const Edges e = EdgesOf(patch);
  const std::vector<double> us = BreakParameters(patch.breaks[0], patch.breaks[2]);
  const std::vector<double> vs = BreakParameters(patch.breaks[1], patch.breaks[3]);
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < us.size(); ++i) {
    for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
      Piece piece;
      piece.net = NetOf(patch, e, {us[i], us[i + 1], vs[j], vs[j + 1]});
      piece.native = NativeRectangle(us[i], us[i + 1], vs[j], vs[j + 1]);
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

}  // namespace patchmill::internal
