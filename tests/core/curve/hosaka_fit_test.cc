// Hosaka's segment: vectors of [curves, section 4], and each fit put back into the curve.
#include "core/curve/hosaka_fit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/json.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Json;
using testing::Random;

const Json& Data() {
  static const Json data = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/hosaka_curve.json");
  return data;
}
Vec2 Pair(const Json& j) { return {j[0].Number(), j[1].Number()}; }

// The plane segment with end derivatives of the given lengths and angles.
HosakaSegment Plane(double chord, double beta, double gamma, const HosakaFit& fit) {
  return {Vec3::Zero(),
          Vec3(chord, 0, 0),
          fit.b * Vec3(std::cos(beta), std::sin(beta), 0),
          fit.c * Vec3(std::cos(gamma), std::sin(gamma), 0),
          {}};
}

TEST(HosakaFit, ChordCrossing) {
  const Json& d = Data()["crossing"];
  const double by = d["By"].Number(), cy = d["Cy"].Number();
  const auto t = ChordCrossing(by, cy);
  ASSERT_TRUE(t.has_value());
  EXPECT_NEAR(*t, d["t"].Number(), 1e-12);
  const HosakaSegment s{Vec3::Zero(), Vec3(2, 0, 0), Vec3(1, by, 0), Vec3(1, cy, 0), {}};
  EXPECT_NEAR(Evaluate(s, *t).p.y(), 0, 1e-15);
  EXPECT_FALSE(ChordCrossing(by, -cy).has_value());
}

TEST(HosakaFit, Loop) {
  const Json& d = Data()["loop"];
  const Vec2 b = Pair(d["B"]), c = Pair(d["C"]);
  const auto loop = FindLoop(d["A"].Number(), b, c);
  ASSERT_TRUE(loop.has_value());
  EXPECT_NEAR(loop->first, d["t1"].Number(), 1e-12);
  EXPECT_NEAR(loop->second, d["t2"].Number(), 1e-12);
  // [curves (15)]: sum and product of the two parameters.
  const double difference = d["p"].Number() - d["q"].Number();
  EXPECT_NEAR(loop->first + loop->second, difference + 1, 1e-12);
  EXPECT_NEAR(loop->first * loop->second, difference * difference + d["p"].Number(), 1e-12);
  const HosakaSegment s{Vec3::Zero(), Vec3(d["A"].Number(), 0, 0), Lift(b, 0), Lift(c, 0), {}};
  EXPECT_LE((Xy(Evaluate(s, loop->first).p) - Pair(d["point"])).norm(), 1e-12);
  EXPECT_LE((Evaluate(s, loop->first).p - Evaluate(s, loop->second).p).norm(), 1e-12);
  const Json& none = Data()["noloop"];
  ASSERT_FALSE(none["roots_in_01"].Bool());
  EXPECT_FALSE(FindLoop(none["A"].Number(), Pair(none["B"]), Pair(none["C"])).has_value());
}

TEST(HosakaFit, ThroughAPointOfSpace) {
  const Json& d = Data()["point3d"];
  const double chord = d["A"].Number();
  const Vec3 b = d["Bdir"].Vector(), c = d["Cdir"].Vector(), q = d["point"].Vector();
  const auto fit = FitThroughPoint(chord, b, c, q);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_NEAR(fit->t, d["t"].Number(), 1e-12);
  EXPECT_NEAR(fit->b, d["B"].Number(), 1e-11);  // 1e-12 in t, divided by h(t) cos(gz) = 0.03
  EXPECT_NEAR(fit->c, d["C"].Number(), 1e-11);
  const HosakaSegment s{Vec3::Zero(), Vec3(chord, 0, 0), fit->b * b, fit->c * c, {}};
  EXPECT_LE((Evaluate(s, fit->t).p - q).norm(), 1e-13);
  EXPECT_FALSE(FitThroughPoint(chord, b, c, q + Vec3(9, 0, 0)).ok());
  EXPECT_FALSE(FitThroughPoint(chord, b, c, Vec3(1, 1, 0)).ok());
}

TEST(HosakaFit, Peak) {
  const Json& d = Data()["zmax"];
  const Vec3 b = d["Bdir"].Vector(), c = d["Cdir"].Vector(), q = d["point"].Vector();
  const auto fit = FitPeak(d["A"].Number(), b, c, q.y(), q.z());
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_NEAR(fit->b, d["B"].Number(), 1e-12);
  EXPECT_NEAR(fit->c, d["C"].Number(), 1e-12);
  const HosakaSegment s{Vec3::Zero(), Vec3(d["A"].Number(), 0, 0), fit->b * b, fit->c * c, {}};
  EXPECT_LE((Evaluate(s, fit->t).p - q).norm(), 1e-13);
  EXPECT_NEAR(Evaluate(s, fit->t).d.z(), 0, 1e-15);
}

TEST(HosakaFit, Slope) {
  const Json& d = Data()["slope"];
  const double chord = d["A"].Number(), beta = d["beta"].Number(), gamma = d["gamma"].Number();
  const double theta = d["theta"].Number();
  const Vec2 q(d["x"].Number(), d["y"].Number());
  const auto a = SlopeCubic(chord, beta, gamma, q, theta);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(a[static_cast<std::size_t>(k)] / std::cos(theta), d["coefficients"][k].Number(), 1e-12);
  }
  for (const Json& solution : d["all_solutions"].Items()) {
    const double t = solution[0].Number();
    EXPECT_NEAR(((a[0] * t + a[1]) * t + a[2]) * t + a[3], 0, 1e-12);
    // Its lengths too, negative ones included, lead the curve through the point.
    const HosakaSegment s = Plane(chord, beta, gamma, {t, solution[1].Number(), solution[2].Number()});
    EXPECT_LE((Xy(Evaluate(s, t).p) - q).norm(), 1e-12);
  }
  const auto fits = FitSlope(chord, beta, gamma, q, theta);
  ASSERT_TRUE(fits.ok());
  ASSERT_EQ(fits->size(), 1u);  // the other two roots have a negative length
  const HosakaFit fit = fits->front();
  EXPECT_NEAR(fit.t, d["t"].Number(), 1e-12);
  EXPECT_NEAR(fit.b, d["B"].Number(), 1e-11);
  EXPECT_NEAR(fit.c, d["C"].Number(), 1e-11);
  const CurveJet jet = Evaluate(Plane(chord, beta, gamma, fit), fit.t);
  EXPECT_LE((Xy(jet.p) - q).norm(), 1e-13);
  EXPECT_NEAR(std::atan2(jet.d.y(), jet.d.x()), theta, 1e-12);
  EXPECT_FALSE(FitSlope(chord, beta, beta, q, theta).ok());
}

TEST(HosakaFit, VerticalTangentIsNoException) {
  const double chord = 1.3, beta = 2.2, gamma = -0.4;  // leaves backwards, so the tangent turns over
  const HosakaSegment s = Plane(chord, beta, gamma, {0, 1.8, 1.2});
  double low = 0, high = 0.5;  // x' < 0 at the start
  for (int k = 0; k < 60; ++k) (Evaluate(s, 0.5 * (low + high)).d.x() < 0 ? low : high) = 0.5 * (low + high);
  const auto fits = FitSlope(chord, beta, gamma, Xy(Evaluate(s, low).p), kPi / 2);
  ASSERT_TRUE(fits.ok());
  ASSERT_FALSE(fits->empty());
  EXPECT_NEAR(fits->front().t, low, 1e-9);
  EXPECT_NEAR(fits->front().b, 1.8, 1e-8);
  EXPECT_NEAR(fits->front().c, 1.2, 1e-8);
}

TEST(HosakaFit, Extremum) {
  const Json& d = Data()["extremum"];
  const double chord = d["A"].Number(), beta = d["beta"].Number(), gamma = d["gamma"].Number();
  const Vec2 q(d["x"].Number(), d["y"].Number());
  const auto fits = FitExtremum(chord, beta, gamma, q);
  ASSERT_TRUE(fits.ok());
  ASSERT_FALSE(fits->empty());
  bool found = false;
  for (const HosakaFit& fit : *fits) {
    const CurveJet jet = Evaluate(Plane(chord, beta, gamma, fit), fit.t);
    EXPECT_LE((Xy(jet.p) - q).norm(), 1e-12);
    EXPECT_NEAR(jet.d.y(), 0, 1e-12);
    found = found || (std::abs(fit.t - d["t"].Number()) < 1e-12 &&
                      std::abs(fit.b - d["B"].Number()) < 1e-11 && std::abs(fit.c - d["C"].Number()) < 1e-11);
  }
  EXPECT_TRUE(found);
  // The coefficients for an extremum in the paper's form are those of [curves (22)] with theta = 0 up to a
  // common factor.
  const auto a = SlopeCubic(chord, beta, gamma, q, 0);
  for (int k = 1; k < 4; ++k) {
    EXPECT_NEAR(a[static_cast<std::size_t>(k)] * d["coefficients"][0].Number(),
                a[0] * d["coefficients"][k].Number(), 1e-12);
  }
}

TEST(HosakaFit, ExtraTerm) {
  const Json& d = Data()["D"];
  const double t = d["t"].Number();
  HosakaSegment s{
      Vec3::Zero(), Vec3(1.3, 0, 0), Vec3(1, d["By"].Number(), 0), Vec3(1, d["Cy"].Number(), 0), {}};
  const CurveJet without = Evaluate(s, t);
  const ExtraTerm extra = FitExtraTerm(t, d["y"].Number(), d["dydt"].Number(), without.p.y(), without.d.y());
  EXPECT_NEAR(extra.d0, d["d0"].Number(), 2e-11);  // of size 10
  EXPECT_NEAR(extra.d1, d["d1"].Number(), 2e-11);
  s.extra = {Vec3(0, extra.d0, 0), Vec3(0, extra.d1, 0)};
  EXPECT_NEAR(Evaluate(s, t).p.y(), d["y"].Number(), 1e-14);
  EXPECT_NEAR(Evaluate(s, t).d.y(), d["dydt"].Number(), 1e-13);

  s.extra = {FitExtraAtPeak(s, 0.7, -0.2)};
  EXPECT_NEAR(Evaluate(s, 2.0 / 3).p.y(), 0.7, 1e-15);
  EXPECT_NEAR(Evaluate(s, 2.0 / 3).p.z(), -0.2, 1e-15);
}

TEST(HosakaFit, AxesPutTheStartIntoThePlane) {
  Random random(3);
  for (int k = 0; k < 50; ++k) {
    const HosakaSegment s{
        random.Point(-1, 1), random.Point(-1, 1), random.Point(-1, 1), random.Point(-1, 1), {}};
    const auto axes = HosakaAxes(s);
    ASSERT_TRUE(axes.ok());
    EXPECT_NEAR(axes->determinant(), 1, 1e-14);
    const Vec3 a = *axes * s.a, b = *axes * s.b;
    EXPECT_LE((a - Vec3(s.a.norm(), 0, 0)).norm(), 1e-14);
    EXPECT_NEAR(b.z(), 0, 1e-14);
    EXPECT_GT(b.y(), 0);
  }
  EXPECT_FALSE(HosakaAxes({Vec3::Zero(), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(0, 1, 0), {}}).ok());
}

TEST(Roots, OfCubicsWithKnownRoots) {
  Random random(4);
  for (int k = 0; k < 200; ++k) {
    std::vector<double> roots = {random.Uniform(-0.5, 1.5), random.Uniform(-0.5, 1.5),
                                 random.Uniform(-0.5, 1.5)};
    std::sort(roots.begin(), roots.end());
    if (roots[1] - roots[0] < 0.01 || roots[2] - roots[1] < 0.01) continue;
    const double s = random.Uniform(-3, 3);
    const auto found =
        RootsInUnitInterval({s, -s * (roots[0] + roots[1] + roots[2]),
                             s * (roots[0] * roots[1] + roots[1] * roots[2] + roots[2] * roots[0]),
                             -s * roots[0] * roots[1] * roots[2]});
    std::erase_if(roots, [](double t) { return t <= 0 || t >= 1; });
    ASSERT_EQ(found.size(), roots.size());
    for (std::size_t i = 0; i < roots.size(); ++i) EXPECT_NEAR(found[i], roots[i], 1e-11);
  }
  EXPECT_EQ(RootsInUnitInterval({0, 0, 2, -1}), std::vector<double>{0.5});
  EXPECT_EQ(RootsInUnitInterval({0, 0, 0, 1}).size(), 0u);
}

}  // namespace
}  // namespace patchmill
