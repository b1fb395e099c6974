#include "core/curve/bezier_chain.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/math/bspline_basis.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

BsplineCurve RandomSpline(Random& random, int degree, int inner) {
  BsplineCurve curve;
  curve.degree = degree;
  curve.knots.assign(static_cast<std::size_t>(degree + 1), 2.0);
  for (int k = 0; k < inner; ++k) curve.knots.push_back(random.Uniform(2.1, 4.9));
  curve.knots.insert(curve.knots.end(), static_cast<std::size_t>(degree + 1), 5.0);
  std::ranges::sort(curve.knots);
  for (std::size_t i = 0; i + static_cast<std::size_t>(degree) + 1 < curve.knots.size(); ++i) {
    curve.points.push_back(random.Point(-5, 5));
  }
  return curve;
}

Vec3 At(const BezierChain& chain, double t) {
  int k = 0;
  while (k + 1 < chain.spans() && t >= chain.breaks[static_cast<std::size_t>(k + 1)]) ++k;
  const double a = chain.breaks[static_cast<std::size_t>(k)],
               b = chain.breaks[static_cast<std::size_t>(k + 1)];
  const auto first = chain.points.begin() + k * chain.degree;
  return Evaluate(BezierCurve{{first, first + chain.degree + 1}}, (t - a) / (b - a)).p;
}

TEST(BezierChain, IsTheCurve) {
  Random random(1);
  for (const int degree : {1, 2, 3, 5}) {
    const BsplineCurve curve = RandomSpline(random, degree, 6);
    const auto chain = ChainOf(curve);
    ASSERT_TRUE(chain.ok()) << chain.status();
    EXPECT_EQ(chain->spans(), 7);
    for (int k = 0; k <= 100; ++k) {
      EXPECT_LE((At(*chain, 0.01 * k) - Evaluate(curve, 0.01 * k).p).norm(), 1e-13);
    }
  }
}

TEST(BezierChain, AlikeChainsKeepTheirCurves) {
  Random random(2);
  const BsplineCurve a = RandomSpline(random, 2, 4), b = RandomSpline(random, 4, 3);
  const HermiteCurve c{random.Point(-1, 1), random.Point(-1, 1), random.Point(-1, 1), random.Point(-1, 1)};
  std::vector<BezierChain> chains = {*ChainOf(a), *ChainOf(b), *ChainOf(c)};
  EXPECT_EQ(AlikeSize(chains), 33u);
  ASSERT_TRUE(MakeAlike(chains).ok());
  const auto &x = chains[0], &y = chains[1], &z = chains[2];
  for (const BezierChain& chain : chains) {
    EXPECT_EQ(chain.degree, 4);
    EXPECT_EQ(chain.spans(), 8);
    EXPECT_EQ(chain.breaks, x.breaks);
    EXPECT_EQ(chain.points.size(), 33u);
  }
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.01 * k;
    EXPECT_LE((At(x, t) - Evaluate(a, t).p).norm(), 1e-12);
    EXPECT_LE((At(y, t) - Evaluate(b, t).p).norm(), 1e-12);
    EXPECT_LE((At(z, t) - Evaluate(c, t).p).norm(), 1e-12);
  }
  // As a B-spline with these knots and abscissae it is the same curve, and t its own function.
  BsplineCurve spline{4, ChainKnots(x), x.points};
  EXPECT_LE((Evaluate(spline, 0.37).p - Evaluate(a, 0.37).p).norm(), 1e-12);
  spline.points.clear();
  for (const double t : ControlAbscissae(x)) spline.points.push_back(Vec3(t, 0, 0));
  for (const double t : {0.0, 0.21, 0.64, 1.0}) EXPECT_NEAR(Evaluate(spline, t).p.x(), t, 1e-14);
}

// Breaks that count as one are one; where a chain has two of them, it is refused.
TEST(BezierChain, NearBreaksCountAsOne) {
  const auto chain = [](std::vector<double> breaks) {
    BezierChain made{1, std::move(breaks), {}};
    for (const double t : made.breaks) made.points.push_back(Vec3(t, t * t, 0));
    return made;
  };
  std::vector<BezierChain> chains = {chain({0, 0.5, 1}), chain({0, 0.5 + 0.9e-9, 1}),
                                     chain({0, 0.5 + 1.8e-9, 1})};
  ASSERT_TRUE(MakeAlike(chains).ok());
  for (const BezierChain& c : chains) EXPECT_EQ(c.breaks, (std::vector<double>{0, 0.5, 1}));
  chains = {chain({0, 0.5, 0.5 + 1.5e-9, 1}), chain({0, 0.5 + 0.8e-9, 1})};
  EXPECT_EQ(MakeAlike(chains).code(), absl::StatusCode::kInvalidArgument);
}

TEST(BezierChain, RefusesWhatIsNoCurve) {
  Random random(3);
  const auto refused = [&](auto change) {
    BsplineCurve curve = RandomSpline(random, 3, 2);
    change(curve);
    const auto chain = ChainOf(curve);
    EXPECT_EQ(chain.status().code(), absl::StatusCode::kInvalidArgument);
  };
  refused([](BsplineCurve& c) { c.degree = 0; });
  refused([](BsplineCurve& c) { c.degree = 16; });
  refused([](BsplineCurve& c) { c.points.pop_back(); });
  refused([](BsplineCurve& c) { c.knots[4] = 9; });
  refused([](BsplineCurve& c) { c.knots[5] = std::nan(""); });
  refused([](BsplineCurve& c) { std::ranges::fill(c.knots, 1.0); });
  refused([](BsplineCurve& c) {  // jumps at 3
    c.knots = {2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4};
    c.points.resize(8, Vec3::Zero());
  });
}

}  // namespace
}  // namespace patchmill
