// Splines with given ends: circles, straight lines, curvature at the ends.
#include "core/curve/ended_spline.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<Vec3> Circle(double radius, double sweep, int spans) {
  std::vector<Vec3> points;
  for (int k = 0; k <= spans; ++k) {
    const double a = sweep * k / spans;
    points.push_back(radius * Vec3(std::cos(a), std::sin(a), 0));
  }
  return points;
}
Vec3 Tangent(double angle) { return Vec3(-std::sin(angle), std::cos(angle), 0); }

double WorstRadius(const std::vector<HermiteCurve>& curves, double radius) {
  double worst = 0.0;
  for (const HermiteCurve& c : curves) {
    for (double t = 0; t <= 1; t += 0.03125)
      worst = std::max(worst, std::abs(Evaluate(c, t).p.norm() - radius));
  }
  return worst;
}

// A half circle of two spans: 0.3 % of the radius, where natural ends miss it by 15 %.
TEST(EndedSpline, HalfACircle) {
  const auto points = Circle(85, kPi, 2);
  const auto natural = SplineWithEnds(points, {}, {});
  ASSERT_TRUE(natural.ok());
  EXPECT_GE(WorstRadius(*natural, 85), 0.149 * 85);
  const auto round = SplineWithEnds(points, {Tangent(0), {}}, {7.0 * Tangent(kPi), {}});
  ASSERT_TRUE(round.ok()) << round.status();
  EXPECT_LE(WorstRadius(*round, 85), 0.003 * 85);
  EXPECT_LE(round->front().d0.normalized().cross(Tangent(0)).norm(), 1e-14);
  EXPECT_LE(round->back().d1.normalized().cross(Tangent(kPi)).norm(), 1e-14);
  // Twice continuously differentiable in the chord parameter, as all these splines.
  EXPECT_LE((Evaluate((*round)[0], 1.0).dd - Evaluate((*round)[1], 0.0).dd).norm(), 1e-12 * 85);
}

// One span only, of any angle: the middle lies on the circle.
TEST(EndedSpline, OneSpanIsAnArc) {
  for (const double sweep : {0.3, 1.0, 2.0}) {
    const auto arc = SplineWithEnds(Circle(10, sweep, 1), {Tangent(0), {}}, {Tangent(sweep), {}});
    ASSERT_TRUE(arc.ok()) << arc.status();
    EXPECT_NEAR(Evaluate((*arc)[0], 0.5).p.norm(), 10.0, 1e-4) << sweep;
  }
}

TEST(EndedSpline, StraightPointsStayStraightAndEven) {
  const std::vector<Vec3> points = {Vec3(0, 0, 0), Vec3(1, 2, 2), Vec3(3, 6, 6), Vec3(3.5, 7, 7)};
  const Vec3 along = Vec3(1, 2, 2);
  const auto line = SplineWithEnds(points, {along, {}}, {along, {}});
  ASSERT_TRUE(line.ok()) << line.status();
  for (const HermiteCurve& c : *line) {
    EXPECT_LE((c.d0 - (c.p1 - c.p0)).norm(), 1e-12);
    EXPECT_LE((c.d1 - (c.p1 - c.p0)).norm(), 1e-12);
  }
}

// The curvature vector at the end is the given one; its part along the spline is of no account.
TEST(EndedSpline, CurvatureIsMet) {
  const auto points = Circle(50, 1.5, 4);
  const Vec3 inward = -points[0] / (50.0 * 50.0);
  for (const Vec3& extra : {Vec3(0, 0, 0), Vec3(0, 0.01, 0)}) {
    const auto spline = SplineWithEnds(points, {{}, inward + extra}, {});
    ASSERT_TRUE(spline.ok()) << spline.status();
    const CurveJet jet = Evaluate(spline->front(), 0.0);
    const Vec3 t = jet.d.normalized(), wanted = inward + extra;
    const Vec3 bend = (jet.dd - t * t.dot(jet.dd)) / jet.d.squaredNorm();
    EXPECT_LE((bend - (wanted - t * t.dot(wanted))).norm(), 1e-13);
    const CurveJet other = Evaluate(spline->back(), 1.0);
    EXPECT_LE(other.dd.norm(), 1e-12 * other.d.norm());  // natural
  }
  // With the curvature of the circle at both ends, all of it is nearer to the circle than with natural ends.
  const auto both = SplineWithEnds(points, {{}, inward}, {{}, -points.back() / (50.0 * 50.0)});
  ASSERT_TRUE(both.ok()) << both.status();
  EXPECT_LE(WorstRadius(*both, 50), 0.05 * WorstRadius(*SplineWithEnds(points, {}, {}), 50));
}

}  // namespace
}  // namespace patchmill
