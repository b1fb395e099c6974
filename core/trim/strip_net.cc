#include "core/trim/strip_net.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/status.h"
#include "core/math/bernstein.h"
#include "core/math/tensor_bernstein.h"

namespace patchmill {
namespace {

std::vector<double> RaisedTo(std::vector<double> c, std::size_t size) {
  while (c.size() < size) c = BernsteinElevate(c);
  return c;
}

// (1-t) low(s) + t high(s), or one minus that.
ScaledBernstein<double> Between(const std::vector<double>& low, const std::vector<double>& high,
                                bool complement) {
  const int d = static_cast<int>(low.size()) - 1;
  ScaledBernstein<double> form(d, 1, 0.0);
  for (int i = 0; i <= d; ++i) {
    const double a = low[static_cast<std::size_t>(i)], b = high[static_cast<std::size_t>(i)];
    form(i, 0) = Binomial(d, i) * (complement ? 1.0 - a : a);
    form(i, 1) = Binomial(d, i) * (complement ? 1.0 - b : b);
  }
  return form;
}

std::vector<ScaledBernstein<double>> Powers(const ScaledBernstein<double>& base, int most) {
  std::vector<ScaledBernstein<double>> powers = {ScaledBernstein<double>(0, 0, 1.0)};
  for (int k = 1; k <= most; ++k) {
    ScaledBernstein<double> next(base.m * k, base.n * k, 0.0);
    powers.back().MultiplyInto(base, next);
    powers.push_back(std::move(next));
  }
  return powers;
}

BernsteinNet AlongU(const BernsteinNet& whole, const Strip& strip) {
  const BernsteinNet carrier = SubNet(whole, strip.low.from, strip.low.to, 0.0, 1.0);
  const int p = carrier.degree_u, q = carrier.degree_v;
  const std::size_t size = std::max(strip.low.c.size(), strip.high.c.size());
  const std::vector<double> low = RaisedTo(strip.low.c, size), high = RaisedTo(strip.high.c, size);
  const int d = static_cast<int>(size) - 1;
  const auto v = Powers(Between(low, high, false), q), w = Powers(Between(low, high, true), q);
  ScaledBernstein<Vec4> sum(p + q * d, q, Vec4::Zero());
  for (int j = 0; j <= q; ++j) {
    // The row of the carrier's points j along u times B_j^q(v(s,t)).
    ScaledBernstein<double> basis(q * d, q, 0.0);
    v[static_cast<std::size_t>(j)].MultiplyInto(w[static_cast<std::size_t>(q - j)], basis);
    ScaledBernstein<Vec4> row(p, 0, Vec4::Zero());
    for (int i = 0; i <= p; ++i) {
      row(i, 0) = Binomial(q, j) * Binomial(p, i) * carrier.points[static_cast<std::size_t>(i * (q + 1) + j)];
    }
    row.MultiplyInto(basis, sum);
  }
  return {p + q * d, q, carrier.rational, sum.Unscaled()};
}

}  // namespace

BernsteinNet Transposed(const BernsteinNet& net) {
  BernsteinNet turned = net;
  std::swap(turned.degree_u, turned.degree_v);
  for (int i = 0; i <= net.degree_u; ++i) {
    for (int j = 0; j <= net.degree_v; ++j) {
      turned.points[static_cast<std::size_t>(j * (net.degree_u + 1) + i)] =
          net.points[static_cast<std::size_t>(i * (net.degree_v + 1) + j)];
    }
  }
  return turned;
}

int LargestStripDegree(const BernsteinNet& carrier, bool along_u) {
  const int p = along_u ? carrier.degree_u : carrier.degree_v,
            q = along_u ? carrier.degree_v : carrier.degree_u;
  return std::min(3, (kMaxDegree - p) / q);
}

BernsteinNet StripNet(const BernsteinNet& carrier, const Strip& strip) {
  const bool along_u = strip.low.along_u;
  const auto degree = static_cast<int>(std::max(strip.low.c.size(), strip.high.c.size())) - 1;
  PM_CHECK((along_u ? carrier.degree_u + carrier.degree_v * degree
                    : carrier.degree_v + carrier.degree_u * degree) <= kMaxDegree);
  if (along_u) return AlongU(carrier, strip);
  return Transposed(AlongU(Transposed(carrier), strip));
}

}  // namespace patchmill
