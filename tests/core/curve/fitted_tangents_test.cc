// Tangent lengths from what an edge shall do, each put back into the curve.
#include "core/curve/fitted_tangents.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/curve/hosaka_fit.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

// A random rotation's columns.
Eigen::Matrix3d Frame(Random& random) {
  const Vec3 x = random.Point(-1, 1).normalized(), y = x.cross(random.Point(-1, 1)).normalized();
  Eigen::Matrix3d frame;
  frame << x, y, x.cross(y);
  return frame;
}

// Distance of a curve from a point, and the sine between its tangent there and a direction.
struct Passing {
  double distance = 1e300, sine = 1.0;
};
Passing PassingBy(const HermiteCurve& curve, const Vec3& point, const Vec3& direction) {
  double best = 0.0, nearest = 1e300;
  for (double t = 0.0; t <= 1.0; t += 1.0 / 4096) {
    const double d = (Evaluate(curve, t).p - point).norm();
    if (d < nearest) nearest = d, best = t;
  }
  for (int i = 0; i < 30; ++i) {
    const CurveJet jet = Evaluate(curve, best);
    best += (point - jet.p).dot(jet.d) / jet.d.squaredNorm();
  }
  const CurveJet jet = Evaluate(curve, best);
  return {(jet.p - point).norm(), jet.d.normalized().cross(direction.normalized()).norm()};
}

TEST(ArcTangents, MeetTheArcInItsMiddle) {
  Random random(1);
  for (const double angle : {0.1, 1.0, kPi / 2, 3.0, 4.5, 6.0}) {
    const Eigen::Matrix3d frame = Frame(random);
    const double radius = random.Uniform(1, 50);
    const auto at = [&](double a) -> Vec3 { return frame * Vec3(std::cos(a), std::sin(a), 0) * radius; };
    const auto along = [&](double a) -> Vec3 { return frame * Vec3(-std::sin(a), std::cos(a), 0); };
    const auto t = ArcTangents({at(0), along(0), at(angle), -along(angle)});
    ASSERT_TRUE(t.ok()) << t.status();
    EXPECT_NEAR(t->t1.norm(), 4 * radius * std::tan(angle / 4), 1e-12 * radius * t->t1.norm());
    const HermiteCurve curve = EdgeCurve(at(0), at(angle), *t);
    EXPECT_LE((Evaluate(curve, 0.5).p - at(angle / 2)).norm(), 1e-11 * radius);
  }
}

TEST(ArcTangents, AStraightEdgeIsItsChord) {
  const auto t = ArcTangents({Vec3(1, 2, 3), Vec3(1, 0, 0), Vec3(5, 2, 3), Vec3(-1, 0, 0)});
  ASSERT_TRUE(t.ok());
  EXPECT_EQ(t->t1, Vec3(4, 0, 0));
  EXPECT_FALSE(ArcTangents({Vec3(1, 2, 3), Vec3(-1, 0, 0), Vec3(5, 2, 3), Vec3(1, 0, 0)}).ok());
  EXPECT_FALSE(ArcTangents({Vec3(1, 2, 3), Vec3(-1, 0, 0), Vec3(1, 2, 3), Vec3(1, 0, 0)}).ok());
}

// Lengths hidden in a random segment come back.
TEST(TangentsThroughPoint, FindTheHiddenLengths) {
  Random random(2);
  for (int k = 0; k < 200; ++k) {
    const Vec3 p1 = random.Point(-9, 9), p2 = random.Point(-9, 9), t1 = random.Point(-9, 9),
               t2 = random.Point(-9, 9);
    const HermiteCurve curve{p1, t1, p2, -t2};
    const Vec3 point = Evaluate(curve, random.Uniform(0.1, 0.9)).p, peak = Evaluate(curve, 2.0 / 3.0).p;
    const EdgeDirections ends{p1, t1.normalized(), p2, t2.normalized()};
    const auto through = TangentsThroughPoint(ends, point);
    ASSERT_TRUE(through.ok()) << through.status();
    EXPECT_LE((through->t1 - t1).norm() + (through->t2 - t2).norm(), 1e-6);  // badly told apart near an end
    EXPECT_LE(PassingBy(EdgeCurve(p1, p2, *through), point, t1).distance, 1e-10);
    const auto by_peak = TangentsWithPeak(ends, peak + random.Uniform(-3, 3) * (p2 - p1));
    ASSERT_TRUE(by_peak.ok()) << by_peak.status();
    EXPECT_LE((by_peak->t1 - t1).norm() + (by_peak->t2 - t2).norm(), 1e-9);
    // Farthest from the plane of chord and start tangent there.
    const Vec3 normal = (p2 - p1).cross(t1).normalized();
    EXPECT_NEAR(Evaluate(EdgeCurve(p1, p2, *by_peak), 2.0 / 3.0).d.dot(normal), 0, 1e-10);
  }
}

TEST(TangentsWithSlope, PassThePointAlongTheSlope) {
  Random random(3);
  int extrema = 0;
  for (int k = 0; k < 200; ++k) {
    const Eigen::Matrix3d frame = Frame(random);
    const double chord = random.Uniform(2, 20);
    const auto in_plane = [&](double length, double angle) -> Vec3 {
      return frame * Vec3(length * std::cos(angle), length * std::sin(angle), 0);
    };
    const Vec3 p1 = random.Point(-5, 5), p2 = p1 + in_plane(chord, 0);
    const Vec3 t1 = in_plane(random.Uniform(0.5, 1.5) * chord, random.Uniform(0.2, 1.3)),
               t2 = in_plane(random.Uniform(0.5, 1.5) * chord, kPi - random.Uniform(0.2, 1.3));
    const HermiteCurve curve{p1, t1, p2, -t2};
    const EdgeDirections ends{p1, t1.normalized(), p2, t2.normalized()};
    const CurveJet jet = Evaluate(curve, random.Uniform(0.15, 0.85));
    const auto slope = TangentsWithSlope(ends, jet.p, -3.0 * jet.d);
    ASSERT_TRUE(slope.ok()) << slope.status();
    const Passing there = PassingBy(EdgeCurve(p1, p2, *slope), jet.p, jet.d);
    EXPECT_LE(there.distance, 1e-9);
    EXPECT_LE(there.sine, 1e-7);
    // No solution with shorter tangents was passed over: that of the curve it was taken from.
    EXPECT_LE(std::max(slope->t1.norm(), slope->t2.norm()), std::max(t1.norm(), t2.norm()) * (1 + 1e-6));

    const Vec3 y = frame.col(1);
    double low = 0.0, high = 1.0;  // y rises at the start and falls at the end
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (Evaluate(curve, middle).d.dot(y) > 0 ? low : high) = middle;
    }
    const Vec3 top = Evaluate(curve, low).p;
    const auto extremum = TangentsWithSlope(ends, top, std::nullopt);
    ASSERT_TRUE(extremum.ok()) << extremum.status();
    const HermiteCurve found = EdgeCurve(p1, p2, *extremum);
    EXPECT_LE(PassingBy(found, top, p2 - p1).distance, 1e-9);
    double highest = -1e300;
    for (double t = 0; t <= 1; t += 1.0 / 1024)
      highest = std::max(highest, (Evaluate(found, t).p - top).dot(y));
    extrema += highest <= 1e-9;
  }
  EXPECT_GE(extrema, 195);  // of all the curve's extrema there the named one is the highest as a rule
}

TEST(TangentsWithSlope, SaysWhatIsMissing) {
  const EdgeDirections ends{Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(4, 0, 0), Vec3(0, 1, 0)};
  const auto message = [](const absl::StatusOr<EdgeTangents>& t) {
    return std::string(t.status().message());
  };
  EXPECT_NE(message(TangentsWithSlope(ends, Vec3(2, 1, 0.1), {})).find("leave their plane by 0.025"),
            std::string::npos);
  EXPECT_NE(message(TangentsWithSlope(ends, Vec3(2, 1, 0), {})).find("parallel"), std::string::npos);
  EdgeDirections straight = ends;
  straight.u1 = Vec3(1, 0, 0), straight.u2 = Vec3(-1, 0, 0);
  EXPECT_NE(message(TangentsWithSlope(straight, Vec3(2, 1, 0), {})).find("along the chord"),
            std::string::npos);
  EdgeDirections leaning = ends;
  leaning.u2 = Vec3(-1, 1, 0).normalized();
  EXPECT_NE(message(TangentsWithSlope(leaning, Vec3(2, -1, 0), {})).find("no segment"), std::string::npos);
}

TEST(LedThrough, KeepsEndsAndMeetsThePlace) {
  Random random(4);
  for (int k = 0; k < 100; ++k) {
    const HermiteCurve curve{random.Point(-9, 9), random.Point(-9, 9), random.Point(-9, 9),
                             random.Point(-9, 9)};
    const Vec3 point = random.Point(-9, 9), derivative = random.Point(-9, 9);
    const double t = random.Uniform(0.05, 0.95);
    for (const bool slope : {false, true}) {
      const HosakaSegment led = LedThrough(curve, t, point, slope ? std::optional(derivative) : std::nullopt);
      EXPECT_EQ(led.extra.size(), slope ? 2u : 1u);
      EXPECT_LE((Evaluate(led, t).p - point).norm(), 1e-12);
      if (slope) {
        EXPECT_LE((Evaluate(led, t).d - derivative).norm(), 1e-10);
      }
      EXPECT_LE((Evaluate(led, 0).d - curve.d0).norm() + (Evaluate(led, 1).d - curve.d1).norm(), 1e-12);
      EXPECT_LE((Evaluate(led, 0).p - curve.p0).norm() + (Evaluate(led, 1).p - curve.p1).norm(), 1e-12);
    }
  }
}

TEST(FindLoop, OfACurveInSpaceIsThatOfItsPlane) {
  Random random(5);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Matrix3d frame = Frame(random);
    const Vec3 start = random.Point(-5, 5);
    const Vec2 b(6 + random.Uniform(-1, 1), 5 + random.Uniform(-1, 1)), c(5 + random.Uniform(-1, 1), -6);
    const auto plane = FindLoop(1.0, b, c);
    const HermiteCurve curve{start, frame * Lift(b, 0), start + frame.col(0), frame * Lift(c, 0)};
    const auto space = FindLoop(curve);
    ASSERT_EQ(plane.has_value(), space.has_value());
    if (!plane) continue;
    EXPECT_LE((Evaluate(curve, space->first).p - Evaluate(curve, space->second).p).norm(), 1e-10);
    EXPECT_NEAR(space->first, plane->first, 1e-10);
  }
  EXPECT_FALSE(
      FindLoop(HermiteCurve{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0)}).has_value());
  EXPECT_FALSE(FindLoop(HermiteCurve{}).has_value());
}

}  // namespace
}  // namespace patchmill
