#include "core/patch/bulge.h"

#include <algorithm>
#include <array>

#include "core/math/bernstein.h"
#include "core/patch/kinds.h"

namespace patchmill {
namespace {

using Scalar = ScaledBernstein<double>;
using Coefficients = std::array<double, 6>;

// Of the factor along one parameter, as a quintic of the share of the way from the border to the place
// [shapes (41)]. `near`: the length of this way, `far`: that of the way from the opposite border.
Coefficients Quintic(double near, double far) {
  const double ratio = near / std::max(near, far);
  return {0.0, 0.0, 0.0, 1.0 - 0.5 * ratio * ratio, 1.0, 1.0};
}

struct Factor {
  double f = 0.0, d = 0.0, dd = 0.0;
};
Factor FactorAt(double at, double t) {
  const bool before = t <= at;
  const double near = before ? at : 1.0 - at, sign = before ? 1.0 : -1.0;
  const Coefficients c = Quintic(near, 1.0 - near);
  BasisJet b;
  AllBernsteinJet(5, std::min((before ? t : 1.0 - t) / near, 1.0), b);
  Factor sum;
  for (std::size_t k = 3; k < 6; ++k) {
    sum.f += c[k] * b.f[k];
    sum.d += c[k] * b.d[k] * sign / near;
    sum.dd += c[k] * b.dd[k] / (near * near);
  }
  return sum;
}

// The Bernstein coefficients of the factor on [t0, t1], which lies on one side of the place.
Coefficients FactorOn(double at, double t0, double t1) {
  const bool before = t1 <= at;
  const double near = before ? at : 1.0 - at;
  Coefficients c = Quintic(near, 1.0 - near);
  double from = t0 / near, to = t1 / near;
  if (!before) {
    from = (t0 - at) / near, to = (t1 - at) / near;
    std::ranges::reverse(c);
  }
  from = std::clamp(from, 0.0, 1.0), to = std::clamp(to, 0.0, 1.0);
  if (from > 0.0) KeepRight(c.data(), 5, 1, from);
  if (to < 1.0) KeepLeft(c.data(), 5, 1, (to - from) / (1.0 - from));
  return c;
}

std::vector<double> Cuts(double t0, double t1, const std::vector<Bulge>& bulges, double Bulge::*at) {
  std::vector<double> cuts = {t0, t1};
  for (const Bulge& b : bulges) {
    if (b.*at > t0 && b.*at < t1) cuts.push_back(b.*at);
  }
  std::ranges::sort(cuts);
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

Scalar Ones(int m, int n) {
  Scalar ones(m, n, 0.0);
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) ones(i, j) = Binomial(m, i) * Binomial(n, j);
  }
  return ones;
}

template <class T>
ScaledBernstein<T> Scaled(int m, int n, const std::vector<T>& points, const T& zero) {
  ScaledBernstein<T> form(m, n, zero);
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) {
      form(i, j) = Binomial(m, i) * Binomial(n, j) * points[static_cast<std::size_t>(i * (n + 1) + j)];
    }
  }
  return form;
}

// The weights on a part of the patch.
Scalar WeightOn(const Scalar& weight, const ParameterBox& box) {
  BernsteinNet net{weight.m, weight.n, true, {}};
  for (const double w : weight.Unscaled()) net.points.emplace_back(0.0, 0.0, 0.0, w);
  const BernsteinNet part = SubNet(net, box.u0, box.u1, box.v0, box.v1);
  std::vector<double> values;
  for (const Vec4& p : part.points) values.push_back(p.w());
  return Scaled(weight.m, weight.n, values, 0.0);
}

// The sum of the bulges on a part of the patch that none of their places cuts.
ScaledBernstein<Vec4> SumOn(const std::vector<Bulge>& bulges, const ParameterBox& box) {
  ScaledBernstein<Vec4> sum(5, 5, Vec4::Zero());
  for (const Bulge& b : bulges) {
    const Coefficients cu = FactorOn(b.u, box.u0, box.u1), cv = FactorOn(b.v, box.v0, box.v1);
    for (int i = 0; i <= 5; ++i) {
      for (int j = 0; j <= 5; ++j) {
        const double w = Binomial(5, i) * cu[static_cast<std::size_t>(i)] * Binomial(5, j) *
                         cv[static_cast<std::size_t>(j)];
        sum(i, j).head<3>() += w * b.by;
      }
    }
  }
  return sum;
}

}  // namespace

Jet2 BulgeWeight(double at_u, double at_v, double u, double v) {
  const Factor a = FactorAt(at_u, u), b = FactorAt(at_v, v);
  return {a.f * b.f, a.d * b.f, a.f * b.d, a.dd * b.f, a.d * b.d, a.f * b.dd};
}

namespace internal {

void AddBulges(const std::vector<Bulge>& bulges, double u, double v, SurfaceJet& s) {
  for (const Bulge& b : bulges) AddTerm(BulgeWeight(b.u, b.v, u, v), b.by, s);
}

std::vector<Piece> WithBulges(const std::vector<Piece>& pieces, const std::vector<Bulge>& bulges,
                              const Scalar& weight) {
  std::vector<Piece> all;
  for (const Piece& piece : pieces) {
    const Vec2 low = piece.native[0], high = piece.native[3];
    const std::vector<double> us = Cuts(low.x(), high.x(), bulges, &Bulge::u),
                              vs = Cuts(low.y(), high.y(), bulges, &Bulge::v);
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
      for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
        const auto share = [](double t, double t0, double t1) { return (t - t0) / (t1 - t0); };
        const BernsteinNet net =
            SubNet(piece.net, share(us[i], low.x(), high.x()), share(us[i + 1], low.x(), high.x()),
                   share(vs[j], low.y(), high.y()), share(vs[j + 1], low.y(), high.y()));
        const ParameterBox box{us[i], us[i + 1], vs[j], vs[j + 1]};
        const int m = std::max(net.degree_u, weight.m + 5), n = std::max(net.degree_v, weight.n + 5);
        ScaledBernstein<Vec4> sum(m, n, Vec4::Zero());
        Scaled(net.degree_u, net.degree_v, net.points, Vec4(Vec4::Zero()))
            .MultiplyInto(Ones(m - net.degree_u, n - net.degree_v), sum);
        const Scalar own = WeightOn(weight, box);
        Scalar raised(m - 5, n - 5, 0.0);
        own.MultiplyInto(Ones(m - 5 - own.m, n - 5 - own.n), raised);
        SumOn(bulges, box).MultiplyInto(raised, sum);
        Piece& part = all.emplace_back(piece);
        part.net = {m, n, net.rational, sum.Unscaled()};
        if (!net.rational) {
          for (Vec4& p : part.net.points) p.w() = 1.0;
        }
        part.native = NativeRectangle(box.u0, box.u1, box.v0, box.v1);
      }
    }
  }
  return all;
}

}  // namespace internal
}  // namespace patchmill
