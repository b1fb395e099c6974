#include "core/math/bernstein.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/base/vec.h"
#include "core/math/tensor_bernstein.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

double Value(const std::vector<double>& c, double t) {
  double b[kMaxBasisDegree + 1];
  AllBernstein(static_cast<int>(c.size()) - 1, t, b);
  return std::inner_product(c.begin(), c.end(), b, 0.0);
}

std::vector<double> RandomCoefficients(Random& random, int degree) {
  std::vector<double> c;
  for (int i = 0; i <= degree; ++i) c.push_back(random.Uniform(-1, 1));
  return c;
}

TEST(Binomial, IsPascalsTriangle) {
  for (int n = 0; n <= 2 * kMaxBasisDegree; ++n) {
    double sum = 0;
    for (int k = 0; k <= n; ++k) {
      sum += Binomial(n, k);
      if (n > 0 && k > 0 && k < n) {
        EXPECT_EQ(Binomial(n, k), Binomial(n - 1, k - 1) + Binomial(n - 1, k));
      }
    }
    EXPECT_EQ(sum, std::ldexp(1.0, n));
  }
}

TEST(AllBernstein, IsTheDefinition) {
  Random random(1);
  for (int n = 0; n <= kMaxBasisDegree; ++n) {
    for (int k = 0; k < 20; ++k) {
      const double t = k == 0 ? 0.0 : k == 1 ? 1.0 : random.Unit();
      double b[kMaxBasisDegree + 1], mirrored[kMaxBasisDegree + 1];
      AllBernstein(n, t, b);
      AllBernstein(n, 1.0 - t, mirrored);
      for (int i = 0; i <= n; ++i) {
        const double exact = Binomial(n, i) * std::pow(1 - t, n - i) * std::pow(t, i);
        EXPECT_NEAR(b[i], exact, 1e-14 * exact);
        EXPECT_NEAR(b[i], mirrored[n - i], 1e-14 * b[i] + 1e-300);
      }
      EXPECT_NEAR(std::accumulate(b, b + n + 1, 0.0), 1.0, 1e-15 * (n + 1));
    }
  }
}

TEST(AllBernsteinJet, SumsAndMoments) {
  // sum B = 1, sum (i/n) B = t and sum i(i-1)/(n(n-1)) B = t^2, with both derivatives.
  Random random(2);
  for (int n = 0; n <= kMaxBasisDegree; ++n) {
    for (int k = 0; k < 20; ++k) {
      const double t = random.Uniform(-0.1, 1.1);
      BasisJet b;
      AllBernsteinJet(n, t, b);
      double f[3] = {}, d[3] = {}, dd[3] = {};
      for (int i = 0; i <= n; ++i) {
        const double weight[3] = {1.0, n > 0 ? double(i) / n : 0.0,
                                  n > 1 ? i * (i - 1.0) / (n * (n - 1.0)) : 0.0};
        for (int m = 0; m < 3; ++m) {
          f[m] += weight[m] * b.f[i];
          d[m] += weight[m] * b.d[i];
          dd[m] += weight[m] * b.dd[i];
        }
      }
      const double tolerance = 1e-12;
      EXPECT_NEAR(f[0], 1, tolerance);
      EXPECT_NEAR(d[0], 0, tolerance);
      EXPECT_NEAR(dd[0], 0, 10 * tolerance);
      if (n >= 1) {
        EXPECT_NEAR(f[1], t, tolerance);
        EXPECT_NEAR(d[1], 1, tolerance);
        EXPECT_NEAR(dd[1], 0, 10 * tolerance);
      }
      if (n >= 2) {
        EXPECT_NEAR(f[2], t * t, tolerance);
        EXPECT_NEAR(d[2], 2 * t, tolerance);
        EXPECT_NEAR(dd[2], 2, 10 * tolerance);
      }
    }
  }
}

TEST(BernsteinProduct, MultipliesValues) {
  Random random(3);
  for (int m = 0; m <= 7; ++m) {
    for (int n = 0; n <= 8; ++n) {
      const auto a = RandomCoefficients(random, m), b = RandomCoefficients(random, n);
      const auto c = BernsteinProduct(a, b);
      ASSERT_EQ(static_cast<int>(c.size()), m + n + 1);
      for (const double t : {0.0, 0.17, 0.5, 0.93, 1.0})
        EXPECT_NEAR(Value(c, t), Value(a, t) * Value(b, t), 1e-14);
    }
  }
}

TEST(BernsteinElevate, KeepsThePolynomial) {
  Random random(4);
  for (int n = 0; n < kMaxBasisDegree; ++n) {
    const auto a = RandomCoefficients(random, n), c = BernsteinElevate(a);
    ASSERT_EQ(c.size(), a.size() + 1);
    for (const double t : {0.0, 0.17, 0.5, 0.93, 1.0}) EXPECT_NEAR(Value(c, t), Value(a, t), 1e-14);
  }
}

TEST(KeepLeftAndRight, AreThePartsOfTheCurve) {
  Random random(5);
  for (int n = 0; n <= kMaxBasisDegree; ++n) {
    const auto a = RandomCoefficients(random, n);
    for (const double t : {0.25, 0.7}) {
      auto left = a, right = a;
      KeepLeft(left.data(), n, 1, t);
      KeepRight(right.data(), n, 1, t);
      for (const double s : {0.0, 0.3, 1.0}) {
        EXPECT_NEAR(Value(left, s), Value(a, t * s), 1e-14);
        EXPECT_NEAR(Value(right, s), Value(a, t + (1 - t) * s), 1e-14);
      }
    }
    auto same = a;
    KeepLeft(same.data(), n, 1, 1.0);
    KeepRight(same.data(), n, 1, 0.0);
    EXPECT_EQ(same, a);  // to the bit
  }
}

TEST(KeepLeft, HonoursStride) {
  std::vector<double> a = {1, 100, 2, 200, 5, 300};
  KeepLeft(a.data(), 2, 2, 0.5);
  EXPECT_EQ(a, (std::vector<double>{1, 100, 1.5, 200, 2.5, 300}));
}

TEST(ScaledBernstein, ProductOfTwoVariables) {
  Random random(6);
  const auto scaled = [](const std::vector<double>& a, const std::vector<double>& b) {
    ScaledBernstein<double> s(static_cast<int>(a.size()) - 1, static_cast<int>(b.size()) - 1, 0.0);
    for (int i = 0; i <= s.m; ++i) {
      for (int j = 0; j <= s.n; ++j) s(i, j) = a[i] * b[j] * Binomial(s.m, i) * Binomial(s.n, j);
    }
    return s;
  };
  const auto a = RandomCoefficients(random, 3), b = RandomCoefficients(random, 2),
             c = RandomCoefficients(random, 1), d = RandomCoefficients(random, 4);
  ScaledBernstein<double> product(4, 6, 0.0);
  scaled(a, b).MultiplyInto(scaled(c, d), product);
  const auto u = BernsteinProduct(a, c), v = BernsteinProduct(b, d), got = product.Unscaled();
  for (int i = 0; i <= 4; ++i) {
    for (int j = 0; j <= 6; ++j) EXPECT_NEAR(got[i * 7 + j], u[i] * v[j], 1e-15);
  }
}

}  // namespace
}  // namespace patchmill
