#include "core/math/bspline_basis.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

// Uneven, unclamped, with a double and a full knot inside.
std::vector<double> Knots(Random& random, int degree) {
  std::vector<double> knots;
  double t = -1;
  for (int i = 0; i < 2 * degree + 6; ++i) {
    t += random.Uniform(0.1, 1.0);
    knots.push_back(t);
  }
  for (int m = 1; m < degree; ++m) knots.push_back(knots[degree + 2]);
  if (degree > 1) knots.push_back(knots[degree + 4]);
  std::sort(knots.begin(), knots.end());
  return knots;
}

double Begin(const std::vector<double>& knots, int degree) { return knots[degree]; }
double End(const std::vector<double>& knots, int degree) { return knots[knots.size() - degree - 1]; }

TEST(FindSpan, HalfOpenAndClamped) {
  const std::vector<double> knots = {0, 0, 0, 1, 2, 2, 3, 4, 4, 4};  // degree 2, inner double knot at 2
  EXPECT_EQ(FindSpan(knots, 2, -5), 2);
  EXPECT_EQ(FindSpan(knots, 2, 0), 2);
  EXPECT_EQ(FindSpan(knots, 2, 0.999), 2);
  EXPECT_EQ(FindSpan(knots, 2, 1), 3);
  EXPECT_EQ(FindSpan(knots, 2, 2), 5);
  EXPECT_EQ(FindSpan(knots, 2, 3), 6);
  EXPECT_EQ(FindSpan(knots, 2, 4), 6);
  EXPECT_EQ(FindSpan(knots, 2, 9), 6);
  EXPECT_EQ(NonEmptySpans(knots, 2), (std::vector<int>{2, 3, 5, 6}));
}

TEST(FindSpan, SkipsEmptySpansAtTheEndsOfTheDomain) {
  const std::vector<double> knots = {0, 1, 2, 2,
                                     3, 3, 4, 5};  // degree 2: domain [2,3], empty spans around it
  for (const double t : {1.0, 2.0, 2.5, 3.0, 7.0}) EXPECT_EQ(FindSpan(knots, 2, t), 3) << t;
  EXPECT_EQ(NonEmptySpans(knots, 2), std::vector<int>{3});
}

TEST(BsplineBasisJet, IsTheBernsteinBasisOnBezierKnots) {
  Random random(1);
  for (int p = 1; p <= kMaxBasisDegree; ++p) {
    std::vector<double> knots(p + 1, 0.0);
    knots.insert(knots.end(), p + 1, 1.0);
    for (int k = 0; k < 10; ++k) {
      const double t = random.Unit();
      BasisJet a, b;
      BsplineBasisJet(knots, p, FindSpan(knots, p, t), t, a);
      AllBernsteinJet(p, t, b);
      for (int i = 0; i <= p; ++i) {
        EXPECT_NEAR(a.f[i], b.f[i], 1e-14);
        EXPECT_NEAR(a.d[i], b.d[i], 1e-13 * p);
        EXPECT_NEAR(a.dd[i], b.dd[i], 1e-12 * p);
      }
    }
  }
}

TEST(BsplineBasisJet, PartitionOfUnityAndLinearPrecision) {
  // sum N = 1; with the Greville values sum xi N = t; Marsden for t^2. All with two derivatives.
  Random random(2);
  for (int p = 1; p <= 9; ++p) {
    const std::vector<double> knots = Knots(random, p);
    for (int s = 0; s < 60; ++s) {
      const double t = random.Uniform(Begin(knots, p), End(knots, p));
      const int k = FindSpan(knots, p, t);
      ASSERT_TRUE(knots[k] <= t && t < knots[k + 1]);
      BasisJet b;
      BsplineBasisJet(knots, p, k, t, b);
      double f[3] = {}, d[3] = {}, dd[3] = {};
      for (int i = 0; i <= p; ++i) {
        EXPECT_GE(b.f[i], 0.0);
        double sum = 0, pairs = 0;  // elementary symmetric functions of the knots inside the support
        for (int m = 1; m <= p; ++m) {
          const double x = knots[k - p + i + m];
          pairs += sum * x;
          sum += x;
        }
        const double weight[3] = {1.0, sum / p, p > 1 ? pairs / (0.5 * p * (p - 1)) : 0.0};
        for (int m = 0; m < 3; ++m) {
          f[m] += weight[m] * b.f[i];
          d[m] += weight[m] * b.d[i];
          dd[m] += weight[m] * b.dd[i];
        }
      }
      const double tolerance = 1e-10;  // derivatives grow with 1/(shortest span)^2
      EXPECT_NEAR(f[0], 1, 1e-14 * p);
      EXPECT_NEAR(d[0], 0, tolerance);
      EXPECT_NEAR(dd[0], 0, tolerance);
      EXPECT_NEAR(f[1], t, 1e-13);
      EXPECT_NEAR(d[1], 1, tolerance);
      EXPECT_NEAR(dd[1], 0, 10 * tolerance);
      if (p > 1) {
        EXPECT_NEAR(f[2], t * t, 1e-12);
        EXPECT_NEAR(d[2], 2 * t, 10 * tolerance);
        EXPECT_NEAR(dd[2], 2, 100 * tolerance);
      }
    }
  }
}

TEST(BezierPointOfSpan, GivesTheSameCurve) {
  Random random(3);
  for (int p = 1; p <= 9; ++p) {
    const std::vector<double> knots = Knots(random, p);
    std::vector<double> d;
    for (std::size_t i = 0; i + p + 1 < knots.size(); ++i) d.push_back(random.Uniform(-1, 1));
    double previous_end = 0;
    for (const int k : NonEmptySpans(knots, p)) {
      std::vector<double> bezier;
      for (int j = 0; j <= p; ++j) bezier.push_back(BezierPointOfSpan(knots, p, k, j, &d[k - p], 1));
      if (k != NonEmptySpans(knots, p).front()) {
        EXPECT_NEAR(bezier.front(), previous_end, 1e-14);
      }
      previous_end = bezier.back();
      for (int s = 0; s <= 8; ++s) {
        const double x = s / 8.0, t = knots[k] + x * (knots[k + 1] - knots[k]);
        BasisJet b, c;
        BsplineBasisJet(knots, p, k, t, b);
        AllBernsteinJet(p, x, c);
        double spline = 0, curve = 0;
        for (int i = 0; i <= p; ++i) {
          spline += b.f[i] * d[k - p + i];
          curve += c.f[i] * bezier[i];
        }
        EXPECT_NEAR(spline, curve, 1e-13);
      }
    }
  }
}

}  // namespace
}  // namespace patchmill
