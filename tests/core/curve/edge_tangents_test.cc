// Tangents of edge curves: planes, arcs, ellipses, motions, refused inputs.
#include "core/curve/edge_tangents.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

TEST(FmillTangents, LieInTheTangentPlanesAndHaveTheChordsLength) {
  Random random(1);
  for (int k = 0; k < 100; ++k) {
    const Vec3 p1 = random.Point(-5, 5), p2 = random.Point(-5, 5);
    const Vec3 n1 = random.Point(-1, 1).normalized(), n2 = random.Point(-1, 1).normalized();
    const double gamma = random.Uniform(0.2, 2);
    const auto t = FmillTangents(p1, n1, p2, n2, gamma);
    ASSERT_TRUE(t.ok());
    EXPECT_NEAR(t->t1.dot(n1), 0, 1e-13);
    EXPECT_NEAR(t->t2.dot(n2), 0, 1e-13);
    EXPECT_NEAR(t->t1.norm(), gamma * (p2 - p1).norm(), 1e-13);
    EXPECT_GT(t->t1.dot(p2 - p1), 0);
    EXPECT_GT(t->t2.dot(p1 - p2), 0);

    // Turning and moving the data turns the tangents; exchanging the ends exchanges them.
    const Eigen::AngleAxisd turn(random.Uniform(-3, 3), random.Point(-1, 1).normalized());
    const Vec3 shift = random.Point(-9, 9);
    const auto moved = FmillTangents(turn * p1 + shift, turn * n1, turn * p2 + shift, turn * n2, gamma);
    EXPECT_LE((moved->t1 - turn * t->t1).norm(), 1e-12);
    const auto back = FmillTangents(p2, n2, p1, n1, gamma);
    EXPECT_EQ(back->t1, t->t2);
    EXPECT_EQ(back->t2, t->t1);
  }
}

TEST(FmillTangents, RefusesWhatHasNoDirection) {
  const Vec3 p(1, 2, 3), n(0, 0, 1);
  EXPECT_FALSE(FmillTangents(p, n, p, n).ok());
  EXPECT_FALSE(FmillTangents(p, n, p + Vec3(0, 0, 2), n).ok());
  EXPECT_FALSE(FmillTangents(p, n, p + Vec3(1, 0, 2), n, 0.0).ok());
  EXPECT_FALSE(FmillTangents(p, n, p + Vec3(1, 0, 2), n, 11.0).ok());
  EXPECT_TRUE(FmillTangents(p, n, p + Vec3(1e-3, 0, 2), n).ok());
}

TEST(ArcTangentLength, MeetsTheArcAtItsMiddle) {
  for (const double angle : {0.1, 0.5, kPi / 2, 2.5}) {
    const double radius = 7;
    const Vec3 p1(radius, 0, 0), p2(radius * std::cos(angle), radius * std::sin(angle), 0);
    const double length = ArcTangentLength((p2 - p1).norm(), angle);
    EXPECT_NEAR(length, 4 * radius * std::tan(angle / 4), 1e-13);
    const HermiteCurve c{p1, length * Vec3(0, 1, 0), p2, length * Vec3(-std::sin(angle), std::cos(angle), 0)};
    EXPECT_NEAR(Evaluate(c, 0.5).p.norm(), radius, 1e-13);
    double worst = 0;
    for (int k = 0; k <= 1000; ++k) {
      worst = std::max(worst, std::abs(Evaluate(c, k / 1000.0).p.norm() / radius - 1));
    }
    if (angle <= kPi / 2) {
      EXPECT_LE(worst, 2.8e-4);
    }
  }
}

TEST(QuarterEllipseTangents, FollowTheEllipse) {
  // Half axes 5 and 2, turned in space: an affine image of the quarter circle, and so is its cubic.
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, -1).normalized());
  const Vec3 a = turn * Vec3(5, 0, 0), b = turn * Vec3(0, 2, 0), center(1, 1, 1);
  const auto t = QuarterEllipseTangents(center + a, 3 * b, center + b, a);
  ASSERT_TRUE(t.ok());
  const HermiteCurve c = EdgeCurve(center + a, center + b, *t);
  for (int k = 0; k <= 100; ++k) {
    const Vec3 q = Evaluate(c, k / 100.0).p - center;
    const double x = q.dot(a) / a.squaredNorm(), y = q.dot(b) / b.squaredNorm();
    EXPECT_NEAR(std::hypot(x, y), 1, 2.8e-4);
    EXPECT_NEAR(q.dot(a.cross(b)), 0, 1e-12);
  }
  const Vec3 middle = Evaluate(c, 0.5).p - center;
  EXPECT_LE((middle - std::sqrt(0.5) * (a + b)).norm(), 1e-13);

  EXPECT_FALSE(QuarterEllipseTangents(center + a, b, center + b, b).ok());
  EXPECT_FALSE(QuarterEllipseTangents(center + a, -b, center + b, a).ok());
  EXPECT_FALSE(QuarterEllipseTangents(center + a, b + 0.3 * a.cross(b), center + b, a).ok());
}

}  // namespace
}  // namespace patchmill
