#include "core/math/bernstein.h"

#include <algorithm>
#include <array>

namespace patchmill {

namespace {

constexpr int kRows = 2 * kMaxBasisDegree + 1;

// Pascal's triangle.
constexpr auto kBinomials = [] {
  std::array<std::array<double, kRows>, kRows> c{};
  for (std::size_t n = 0; n < c.size(); ++n) {
    c[n][0] = 1.0;
    for (std::size_t k = 1; k <= n; ++k) c[n][k] = c[n - 1][k - 1] + c[n - 1][k];
  }
  return c;
}();

}  // namespace

double Binomial(int n, int k) {
  if (n < kRows) return kBinomials[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)];
  double c = 1.0;
  for (int i = 1; i <= std::min(k, n - k); ++i) c = c * (n - i + 1) / i;
  return c;
}

std::vector<double> BernsteinProduct(const std::vector<double>& a, const std::vector<double>& b) {
  const int m = static_cast<int>(a.size()) - 1, n = static_cast<int>(b.size()) - 1;
  std::vector<double> c(a.size() + b.size() - 1, 0.0);
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) c[i + j] += Binomial(m, i) * Binomial(n, j) * a[i] * b[j];
  }
  for (int k = 0; k <= m + n; ++k) c[k] /= Binomial(m + n, k);
  return c;
}

std::vector<double> BernsteinElevate(const std::vector<double>& a) {
  const int n = static_cast<int>(a.size());  // the new degree
  std::vector<double> c(a.size() + 1);
  for (int i = 0; i <= n; ++i) {
    const double t = static_cast<double>(i) / n;
    c[i] = (i > 0 ? t * a[i - 1] : 0.0) + (i < n ? (1.0 - t) * a[i] : 0.0);
  }
  return c;
}

}  // namespace patchmill
