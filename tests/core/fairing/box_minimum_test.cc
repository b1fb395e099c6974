// The least of a quadratic in a box: against its own optimality conditions and a sweep over all choices.
#include "core/fairing/box_minimum.h"

#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;
using Hold = BoxQuadratic::Hold;

// A random chain with a small pull to 0, so that bounds matter far from where they hold.
struct Chain {
  Eigen::MatrixXd h;
  Eigen::VectorXd g;
  BoxQuadratic f;

  Chain(Random& random, int n, double widest) : h(Eigen::MatrixXd::Zero(n, n)), g(n) {
    for (int i = 0; i < n; ++i) {
      const double w = std::pow(10.0, random.Uniform(-2, 2));
      h(i, i) += w + 0.01;
      if (i + 1 < n) h(i + 1, i + 1) += w, h(i, i + 1) = h(i + 1, i) = -w;
      g[i] = random.Uniform(-3, 3);
      f.lower.push_back(-random.Uniform(0, widest));
      f.upper.push_back(random.Uniform(0, widest));
      f.diagonal.push_back(h(i, i));
    }
    for (int i = 0; i < n; ++i) f.diagonal[static_cast<std::size_t>(i)] = h(i, i);
    f.slope = [this](const std::vector<double>& x, std::size_t i) {
      double sum = -g[static_cast<Eigen::Index>(i)];
      for (std::size_t j = 0; j < x.size(); ++j)
        sum += h(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * x[j];
      return sum;
    };
    f.solve = [this](const std::vector<Hold>& holds) {
      Eigen::MatrixXd a = h;
      Eigen::VectorXd b = g;
      for (std::size_t i = 0; i < holds.size(); ++i) {
        if (holds[i] == Hold::kFree) continue;
        const auto row = static_cast<Eigen::Index>(i);
        a.row(row).setZero();
        a(row, row) = 1.0;
        b[row] = holds[i] == Hold::kLower ? f.lower[i] : f.upper[i];
      }
      const Eigen::VectorXd solved = a.partialPivLu().solve(b);
      std::vector<double> x(solved.data(), solved.data() + solved.size());
      for (std::size_t i = 0; i < holds.size(); ++i) {
        if (holds[i] != Hold::kFree) x[i] = holds[i] == Hold::kLower ? f.lower[i] : f.upper[i];
      }
      return x;
    };
  }

  double Value(const std::vector<double>& x) const {
    const Eigen::Map<const Eigen::VectorXd> v(x.data(), static_cast<Eigen::Index>(x.size()));
    return 0.5 * v.dot(h * v) - g.dot(v);
  }
};

TEST(MinimizeInBox, MeetsTheOptimalityConditions) {
  Random random(1);
  int held = 0;
  for (int round = 0; round < 200; ++round) {
    const Chain chain(random, 2 + random.Int(40), std::pow(10.0, random.Uniform(-2, 2)));
    const BoxStep step = MinimizeInBox(chain.f);
    ASSERT_TRUE(step.exact) << round;
    for (std::size_t i = 0; i < step.x.size(); ++i) {
      const double slope = chain.f.slope(step.x, i), eps = 1e-9 * chain.f.diagonal[i];
      EXPECT_GE(step.x[i], chain.f.lower[i]);
      EXPECT_LE(step.x[i], chain.f.upper[i]);
      if (step.x[i] > chain.f.lower[i]) {
        EXPECT_LE(slope, eps);
      }
      if (step.x[i] < chain.f.upper[i]) {
        EXPECT_GE(slope, -eps);
      }
      if (step.x[i] == chain.f.lower[i] || step.x[i] == chain.f.upper[i]) ++held;
    }
  }
  EXPECT_GT(held, 500);
}

TEST(MinimizeInBox, WithoutBoundsItIsOneSolve) {
  Random random(2);
  Chain chain(random, 20, 1.0);
  chain.f.lower.assign(20, -std::numeric_limits<double>::infinity());
  chain.f.upper.assign(20, std::numeric_limits<double>::infinity());
  const BoxStep step = MinimizeInBox(chain.f);
  EXPECT_EQ(step.solves, 1);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_NEAR(chain.f.slope(step.x, i), 0.0, 1e-9);
}

TEST(MinimizeInBox, EqualBoundsHold) {
  Random random(3);
  Chain chain(random, 10, 1.0);
  chain.f.lower[4] = chain.f.upper[4] = 0.0;
  EXPECT_EQ(MinimizeInBox(chain.f).x[4], 0.0);
}

TEST(MinimizeInBox, GuessesThatDoNotSettleStillGoDown) {
  Random random(4);
  Chain chain(random, 30, 0.5);
  // A solver that puts every variable far out, away from its neighbours: each is held, then freed, for ever.
  chain.f.solve = [](const std::vector<Hold>& holds) {
    std::vector<double> x(holds.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = i % 2 == 0 ? -1e6 : 1e6;
    return x;
  };
  const BoxStep step = MinimizeInBox(chain.f);
  EXPECT_FALSE(step.exact);
  EXPECT_EQ(step.solves, kMaxBoxSolves);
  EXPECT_LT(chain.Value(step.x), 0.0);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_GE(step.x[i], chain.f.lower[i]);
    EXPECT_LE(step.x[i], chain.f.upper[i]);
  }
}

}  // namespace
}  // namespace patchmill
