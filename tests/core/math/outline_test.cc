// Signed distances to outlines: closed forms, and a plain winding-free oracle on random rings.
#include "core/math/outline.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

const Ring kSquare = {{-2, -1}, {2, -1}, {2, 1}, {-2, 1}};

TEST(Outline, RectangleInClosedForm) {
  const Outline outline({kSquare});
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec2 q(random.Uniform(-4, 4), random.Uniform(-3, 3));
    const Vec2 off = q.cwiseAbs() - Vec2(2, 1);
    const double expected = off.maxCoeff() <= 0.0 ? -off.maxCoeff() : -Vec2(off.cwiseMax(0.0)).norm();
    EXPECT_NEAR(outline.SignedDistance(q), expected, 1e-14);
  }
}

TEST(Outline, RingsInsideEachOtherAlternateWhateverTheirSense) {
  Ring hole = {{-1, -0.5}, {1, -0.5}, {1, 0.5}, {-1, 0.5}};
  for (int turn = 0; turn < 2; ++turn) {
    const Outline outline({kSquare, hole});
    EXPECT_DOUBLE_EQ(outline.SignedDistance({0, 0}), -0.5);
    EXPECT_DOUBLE_EQ(outline.SignedDistance({1.5, 0}), 0.5);
    EXPECT_DOUBLE_EQ(outline.SignedDistance({3, 0}), -1.0);
    std::reverse(hole.begin(), hole.end());
  }
}

// Every height of a vertex: an edge must count once there.
TEST(Outline, RaysThroughVerticesCountOnce) {
  const Ring star = {{3, 0}, {1, 1}, {0, 3}, {-1, 1}, {-3, 0}, {-1, -1}, {0, -3}, {1, -1}};
  const Outline outline({star});
  for (const double x : {-2.5, -1.5, 0.0, 1.5, 2.5}) EXPECT_GT(outline.SignedDistance({x, 0}), 0.0) << x;
  for (const double y : {-3.0, -1.0, 0.0, 1.0, 3.0}) {
    EXPECT_LT(outline.SignedDistance({-5, y}), 0.0) << y;
    EXPECT_LT(outline.SignedDistance({5, y}), 0.0) << y;
  }
}

TEST(Outline, RandomRingsAgreeWithEveryEdgeInTurn) {
  Random random(3);
  for (int n : {3, 4, 5, 17, 200}) {
    Ring ring;
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * kPi * i / n, r = random.Uniform(2, 6);
      ring.push_back(r * Vec2(std::cos(angle), std::sin(angle)));
    }
    const Outline outline({ring});
    for (int i = 0; i < 500; ++i) {
      const Vec2 q(random.Uniform(-7, 7), random.Uniform(-7, 7));
      double nearest = kInfinity, turn = 0.0;
      for (int k = 0; k < n; ++k) {
        const Vec2 a = ring[static_cast<std::size_t>(k)] - q,
                   b = ring[static_cast<std::size_t>((k + 1) % n)] - q;
        for (int s = 0; s <= 1000; ++s) nearest = std::min(nearest, (a + s * 1e-3 * (b - a)).norm());
        turn += std::atan2(Cross(a, b), a.dot(b));
      }
      const double found = outline.SignedDistance(q);
      if (nearest > 0.02) {
        EXPECT_EQ(found > 0.0, std::abs(turn) > kPi) << n;
      }
      EXPECT_LE(std::abs(found), nearest + 1e-12);
      EXPECT_NEAR(std::abs(found), nearest, 0.02);
    }
  }
}

TEST(Outline, FaultsAreNamed) {
  EXPECT_EQ(OutlineFault({kSquare}), "");
  EXPECT_NE(OutlineFault({}), "");
  EXPECT_NE(OutlineFault({kSquare, {{0, 0}, {1, 1}}}).find("ring 1 has 2 points"), std::string::npos);
  EXPECT_NE(OutlineFault({{{0, 0}, {1, 0}, {2, 0}}}).find("enclose"), std::string::npos);
  EXPECT_NE(OutlineFault({{{1, 1}, {2, 2}, {3, 3}, {1, 1}}}).find("enclose"), std::string::npos);
  EXPECT_NE(OutlineFault({{{1, 1}, {1, 1}, {1, 1}}}).find("enclose"), std::string::npos);
  EXPECT_NE(OutlineFault({{{0, 0}, {1, kInfinity}, {2, 0}}}).find("finite"), std::string::npos);
}

}  // namespace
}  // namespace patchmill
