#include "core/joining/basis_strip.h"

#include <algorithm>
#include <cmath>

#include "core/base/status.h"
#include "core/curve/curve.h"
#include "core/math/bernstein.h"

namespace patchmill {
namespace {

constexpr double kV0 = kControlPlace;
constexpr std::array<double, 3> kMiddle = {(1 - kV0) * (1 - kV0), 2 * kV0*(1 - kV0), kV0* kV0};

// The middle coefficient of a quadratic with the ends c0, c2 and the value m at v0.
template <class Value>
Value MiddleCoefficient(const Value& c0, const Value& m, const Value& c2) {
  return (m - kMiddle[0] * c0 - kMiddle[2] * c2) / kMiddle[1];
}

std::vector<Vec3> Product(const std::vector<double>& f, const std::vector<Vec3>& g) {
  const int m = static_cast<int>(f.size()) - 1, n = static_cast<int>(g.size()) - 1;
  std::vector<Vec3> c(f.size() + g.size() - 1, Vec3::Zero());
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) {
      c[static_cast<std::size_t>(i + j)] += Binomial(m, i) * Binomial(n, j) / Binomial(m + n, i + j) *
                                            f[static_cast<std::size_t>(i)] * g[static_cast<std::size_t>(j)];
    }
  }
  return c;
}

std::vector<Vec3> Raised(const std::array<Vec3, 3>& quadratic, int degree) {
  return Elevated(BezierCurve{{quadratic.begin(), quadratic.end()}}, degree).points;
}

}  // namespace

BasisStrip MakeBasisStrip(const StripPlace& start, const StripPlace& middle, const StripPlace& end) {
  return {
      {start.direction, MiddleCoefficient(start.direction, middle.direction, end.direction), end.direction},
      {start.bend, MiddleCoefficient(start.bend, middle.bend, end.bend), end.bend}};
}

Vec3 BendOf(const ControlVectors& c) {
  const double square = c.first.squaredNorm();
  return (c.second - c.first * (c.first.dot(c.second) / square)) / square;
}

std::optional<ConnectionFactors> FactorsFor(const BasisStrip& strip, const ControlVectors& start,
                                            const ControlVectors& middle, const ControlVectors& end) {
  const auto at = [](const std::array<Vec3, 3>& q) {
    return Vec3(kMiddle[0] * q[0] + kMiddle[1] * q[1] + kMiddle[2] * q[2]);
  };
  const Vec3 a[3] = {strip.a[0], at(strip.a), strip.a[2]}, bend[3] = {strip.A[0], at(strip.A), strip.A[2]};
  const ControlVectors* vectors[3] = {&start, &middle, &end};
  double k[3], l[3];
  for (int i = 0; i < 3; ++i) {
    const double square = a[i].squaredNorm();
    k[i] = vectors[i]->first.dot(a[i]) / square;
    l[i] = (vectors[i]->second - k[i] * k[i] * bend[i]).dot(a[i]) / square;
  }
  const ConnectionFactors factors{{k[0], MiddleCoefficient(k[0], k[1], k[2]), k[2]},
                                  {l[0], MiddleCoefficient(l[0], l[1], l[2]), l[2]}};
  // A quadratic with ends of one sign has no zero in between iff its middle coefficient, signed likewise,
  // exceeds -sqrt(k0 k2) [joining (22)].
  const double sign = k[0] > 0.0 ? 1.0 : -1.0;
  const bool sound = sign * k[0] > 0.0 && sign * k[2] > 0.0 && sign * factors.k[1] > -std::sqrt(k[0] * k[2]);
  return sound ? std::optional(factors) : std::nullopt;
}

ConnectedRows ConnectRows(const ConnectionFactors& factors, const std::vector<Vec3>& a_lower,
                          const std::vector<Vec3>& A_lower) {
  PM_CHECK(a_lower.size() == A_lower.size() + 2);
  const std::vector<double> k(factors.k.begin(), factors.k.end()), l(factors.l.begin(), factors.l.end());
  ConnectedRows rows{Product(k, a_lower), Product(BernsteinProduct(k, k), A_lower)};
  const std::vector<Vec3> along = Product(l, a_lower);
  for (std::size_t i = 0; i < rows.B.size(); ++i) rows.B[i] += along[i];
  return rows;
}

CrossRows Connect(const BasisStrip& strip, const ConnectionFactors& factors) {
  const ConnectedRows rows =
      ConnectRows(factors, Raised(strip.a, kG2Degree - 2), Raised(strip.A, kG2Degree - 4));
  CrossRows cross;
  std::copy(rows.b.begin(), rows.b.end(), cross.first.begin());
  std::copy(rows.B.begin(), rows.B.end(), cross.second.begin());
  return cross;
}

}  // namespace patchmill
