#include "core/curve/spline.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

// From the ends themselves: chords are exact, so that short spans far from the origin lose nothing.
Vec3 Curvature(const HermiteCurve& c, bool at_end) {
  const Vec3 chord = c.p1 - c.p0, d = at_end ? c.d1 : c.d0;
  const Vec3 dd = at_end ? Vec3(-6 * chord + 2 * c.d0 + 4 * c.d1) : Vec3(6 * chord - 4 * c.d0 - 2 * c.d1);
  return (dd - d * (d.dot(dd) / d.squaredNorm())) / d.squaredNorm();
}

std::vector<Vec3> Walk(std::uint64_t seed, int n) {
  Random random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    points.push_back(Vec3(5 * i, 0, 0) + random.Point(-2, 2));
    if (i % 5 == 4) points.push_back(points.back() + random.Point(-0.01, 0.01));  // uneven chords
  }
  return points;
}

// Position, tangent line and curvature vector agree at every point.
void ExpectG2(const HermiteCurve& a, const HermiteCurve& b) {
  EXPECT_EQ(a.p1, b.p0);
  EXPECT_LE((a.d1.normalized() - b.d0.normalized()).norm(), 1e-14);
  const Vec3 ka = Curvature(a, true), kb = Curvature(b, false);
  EXPECT_LE((ka - kb).norm(), 1e-12 * (ka.norm() + 1.0 / std::min(a.d1.norm(), b.d0.norm())));
}

TEST(SplineThrough, SharesTangentAndCurvatureAtEveryPoint) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto points = Walk(seed, 25);
    const auto open = SplineThrough(points, false), closed = SplineThrough(points, true);
    ASSERT_TRUE(open.ok() && closed.ok());
    ASSERT_EQ(open->size(), points.size() - 1);
    ASSERT_EQ(closed->size(), points.size());
    for (std::size_t i = 0; i + 1 < open->size(); ++i) ExpectG2((*open)[i], (*open)[i + 1]);
    for (std::size_t i = 0; i < closed->size(); ++i)
      ExpectG2((*closed)[i], (*closed)[(i + 1) % closed->size()]);
    EXPECT_LE(Curvature(open->front(), false).norm() * open->front().d0.norm(), 1e-12);
    EXPECT_LE(Curvature(open->back(), true).norm() * open->back().d1.norm(), 1e-12);
  }
}

TEST(SplineThrough, ReproducesLinesAndKeepsClampedEnds) {
  const std::vector<double> x = {0, 0.5, 2, 2.25, 4};
  std::vector<Vec3> points;
  for (const double t : x) points.push_back(t * Vec3(2, -1, 2) / 3.0);
  const auto line = SplineThrough(points, false);
  ASSERT_TRUE(line.ok());
  for (std::size_t i = 0; i < line->size(); ++i) {
    EXPECT_LE((Evaluate((*line)[i], 0.3).d - (points[i + 1] - points[i])).norm(), 1e-15);
  }
  const Vec3 start(1, 2, 0.5), end(0, -1, 1);
  const auto bent = SplineThrough(points, false, {start, end});
  ASSERT_TRUE(bent.ok());
  EXPECT_LE((bent->front().d0 / 0.5 - start).norm(), 1e-14);
  EXPECT_LE((bent->back().d1 / 1.75 - end).norm(), 1e-14);
  for (std::size_t i = 0; i + 1 < bent->size(); ++i) ExpectG2((*bent)[i], (*bent)[i + 1]);
}

// Fourth order: the closed spline through n points of a circle leaves it by about 1/n^4.
TEST(SplineThrough, ACircleIsMetToFourthOrder) {
  const auto error = [](int n) {
    std::vector<Vec3> points;
    for (int i = 0; i < n; ++i) points.push_back({std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), 0});
    const auto spline = SplineThrough(points, true);
    double worst = 0.0;
    for (const HermiteCurve& c : *spline) worst = std::max(worst, std::abs(Evaluate(c, 0.5).p.norm() - 1.0));
    return worst;
  };
  EXPECT_LT(error(16), 2e-4);
  EXPECT_NEAR(error(16) / error(32), 16.0, 2.0);
}

TEST(SplineThrough, RefusesWhatHasNoSpline) {
  EXPECT_FALSE(SplineThrough({Vec3(1, 2, 3)}, false).ok());
  EXPECT_FALSE(SplineThrough({Vec3(1, 2, 3), Vec3(4, 5, 6)}, true).ok());
  EXPECT_FALSE(SplineThrough({Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(0, 0, 0)}, false).ok());
  EXPECT_FALSE(SplineThrough({Vec3(1, 2, 3), Vec3(1, 2, std::nan("")), Vec3(0, 0, 0)}, false).ok());
}

}  // namespace
}  // namespace patchmill
