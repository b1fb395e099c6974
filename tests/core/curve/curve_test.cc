// Curves: vectors of [curves (2), (9)], Bezier forms, parts, derivatives against differencing.
#include "core/curve/curve.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/curve/edge_tangents.h"
#include "tests/support/eigen_matchers.h"
#include "tests/support/json.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::IsNear;
using testing::Json;
using testing::LoadJson;
using testing::Random;

#define VECTORS PATCHMILL_SOURCE_DIR "/tests/vectors/"

// f'(t) of order eight.
template <class F>
Vec3 Difference(F f, double t) {
  constexpr double kWeight[4] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280}, kStep = 1e-3;
  Vec3 sum = Vec3::Zero();
  for (int k = 1; k <= 4; ++k) sum += kWeight[k - 1] * (f(t + k * kStep) - f(t - k * kStep));
  return sum / kStep;
}

HosakaSegment RandomSegment(Random& random, int extra) {
  HosakaSegment s{random.Point(-1, 1), random.Point(-1, 1), random.Point(-1, 1), random.Point(-1, 1), {}};
  for (int k = 0; k < extra; ++k) s.extra.push_back(random.Point(-1, 1));
  return s;
}

TEST(HermiteCurve, FmillVector) {
  const Json data = LoadJson(VECTORS "fmill_hermite_curve.json");
  const Vec3 p1 = data["P1"].Vector(), p2 = data["P2"].Vector();
  const auto tangents =
      FmillTangents(p1, data["n1"].Vector(), p2, data["n2"].Vector(), data["gamma"].Number());
  ASSERT_TRUE(tangents.ok());
  EXPECT_THAT(tangents->t1, IsNear(data["T1"].Vector(), 1e-12));
  EXPECT_THAT(tangents->t2, IsNear(data["T2"].Vector(), 1e-12));
  const Curve curve = EdgeCurve(p1, p2, *tangents);
  const int count = static_cast<int>(data["u"].Items().size());
  ASSERT_GE(count, 5);
  for (int k = 0; k < count; ++k) {
    const CurveJet jet = Evaluate(curve, data["u"][k].Number());
    EXPECT_THAT(jet.p, IsNear(data["C"][k].Vector(), 3e-12));
    EXPECT_THAT(jet.d, IsNear(data["dC"][k].Vector(), 3e-12));
    EXPECT_THAT(jet.dd, IsNear(data["ddC"][k].Vector(), 3e-12));
  }
}

TEST(HosakaSegment, PartVector) {
  const Json data = LoadJson(VECTORS "hosaka_curve.json")["sub"];
  const Vec3 a = data["A"].Vector();
  const HermiteCurve whole{Vec3::Zero(), data["B"].Vector(), a, data["C"].Vector()};
  const double t1 = data["t1"].Number(), t2 = data["t2"].Number();
  const HermiteCurve part = Part(whole, t1, t2);
  EXPECT_THAT(part.p1 - part.p0, IsNear(data["AM"].Vector(), 1e-12));
  EXPECT_THAT(part.d0, IsNear(data["BM"].Vector(), 1e-12));
  EXPECT_THAT(part.d1, IsNear(data["CM"].Vector(), 1e-12));
  for (double s = 0; s <= 1; s += 0.125) {
    EXPECT_THAT(Evaluate(part, s).p, IsNear(Evaluate(whole, t1 + s * (t2 - t1)).p, 1e-15));
  }
}

TEST(BezierCurve, PartIsTheSameCurve) {
  Random random(4);
  for (int degree = 1; degree <= 11; ++degree) {
    BezierCurve whole;
    for (int i = 0; i <= degree; ++i) whole.points.push_back(random.Point(-1, 1));
    for (const auto& [t1, t2] :
         {std::pair(0.0, 1.0), std::pair(0.0, 0.3), std::pair(0.2, 0.9), std::pair(0.7, 1.0)}) {
      const BezierCurve part = Part(whole, t1, t2);
      for (double s = 0; s <= 1; s += 0.125) {
        const CurveJet a = Evaluate(part, s), b = Evaluate(whole, t1 + s * (t2 - t1));
        EXPECT_THAT(a.p, IsNear(b.p, 1e-14));
        EXPECT_THAT(a.d, IsNear((t2 - t1) * b.d, 1e-13));
      }
      if (t1 == 0.0) {
        EXPECT_EQ(part.points.front(), whole.points.front());
      }
      if (t2 == 1.0) {
        EXPECT_EQ(part.points.back(), whole.points.back());
      }
    }
  }
}

TEST(HosakaSegment, ExtraTermKeepsEndsAndEndDerivatives) {
  Random random(1);
  for (int k = 0; k <= 11; ++k) {
    const HosakaSegment s = RandomSegment(random, k);
    for (const double t : {0.0, 1.0}) {
      const CurveJet jet = Evaluate(s, t);
      EXPECT_THAT(jet.p, IsNear(s.origin + t * s.a, 1e-15));
      EXPECT_THAT(jet.d, IsNear(t == 0 ? s.b : s.c, 1e-14));
    }
  }
}

TEST(Curve, BezierFormIsTheSameCurve) {
  Random random(2);
  for (int extra = 0; extra <= 11; ++extra) {
    const Curve s = RandomSegment(random, extra);
    const auto bezier = ToBezier(s);
    ASSERT_TRUE(bezier.ok());
    for (int k = 0; k < 20; ++k) {
      const double t = random.Unit();
      const CurveJet a = Evaluate(s, t), b = Evaluate(*bezier, t);
      EXPECT_THAT(a.p, IsNear(b.p, 1e-13));
      EXPECT_THAT(a.d, IsNear(b.d, 1e-12));
      EXPECT_THAT(a.dd, IsNear(b.dd, 1e-11));
    }
  }
  HosakaSegment too_long = RandomSegment(random, 13);
  EXPECT_FALSE(ToBezier(Curve(too_long)).ok());
}

TEST(Curve, BsplineOfOneSpanIsBezier) {
  Random random(3);
  BsplineCurve spline{3, {-1, 0, 1, 2, 4, 5, 5, 6}, {}};  // one span [2,4], not clamped
  for (int k = 0; k < 4; ++k) spline.points.push_back(random.Point(-1, 1));
  const auto bezier = ToBezier(Curve(spline));
  ASSERT_TRUE(bezier.ok());
  for (int k = 0; k < 20; ++k) {
    const double t = random.Unit();
    const CurveJet a = Evaluate(Curve(spline), t), b = Evaluate(*bezier, t);
    EXPECT_THAT(a.p, IsNear(b.p, 1e-14));
    EXPECT_THAT(a.d, IsNear(b.d, 1e-13));
    EXPECT_THAT(a.dd, IsNear(b.dd, 1e-12));
  }
  spline.knots = {0, 0, 0, 0, 1, 2, 2, 2, 2};
  spline.points.push_back(random.Point(-1, 1));
  EXPECT_FALSE(ToBezier(Curve(spline)).ok());
}

TEST(Curve, DerivativesAgreeWithDifferencing) {
  Random random(4);
  std::vector<Curve> curves;
  curves.push_back(
      HermiteCurve{random.Point(-1, 1), random.Point(-1, 1), random.Point(-1, 1), random.Point(-1, 1)});
  for (int n = 1; n <= 9; ++n) {
    BezierCurve b;
    for (int k = 0; k <= n; ++k) b.points.push_back(random.Point(-1, 1));
    curves.push_back(b);
  }
  BsplineCurve s{4, {0, 0, 0, 0, 0, 10, 10, 10, 10, 10}, {}};
  for (int k = 0; k < 5; ++k) s.points.push_back(random.Point(-1, 1));
  curves.push_back(s);
  curves.push_back(RandomSegment(random, 3));
  for (const Curve& c : curves) {
    for (int k = 0; k < 20; ++k) {
      const double t = random.Uniform(0.1, 0.9);
      const CurveJet jet = Evaluate(c, t);
      EXPECT_THAT(Difference([&](double x) { return Evaluate(c, x).p; }, t), IsNear(jet.d, 1e-10));
      EXPECT_THAT(Difference([&](double x) { return Evaluate(c, x).d; }, t), IsNear(jet.dd, 1e-9));
    }
  }
}

Curve Moved(Curve curve, const Eigen::Affine3d& motion) {
  const Eigen::Matrix3d turn = motion.linear();
  if (auto* h = std::get_if<HermiteCurve>(&curve)) {
    h->p0 = motion * h->p0, h->p1 = motion * h->p1;
    h->d0 = turn * h->d0, h->d1 = turn * h->d1;
  } else if (auto* s = std::get_if<HosakaSegment>(&curve)) {
    s->origin = motion * s->origin;
    s->a = turn * s->a, s->b = turn * s->b, s->c = turn * s->c;
    for (Vec3& d : s->extra) d = turn * d;
  } else {
    auto& points = std::holds_alternative<BezierCurve>(curve) ? std::get<BezierCurve>(curve).points
                                                              : std::get<BsplineCurve>(curve).points;
    for (Vec3& p : points) p = motion * p;
  }
  return curve;
}

Vec3 CurvatureVector(const CurveJet& jet) {
  const Vec3 along = jet.d.normalized();
  return (jet.dd - along * along.dot(jet.dd)) / jet.d.squaredNorm();
}

// Every kind: moved, run the other way, raised in degree; places and curvatures go along.
TEST(Curve, RewrittenIsTheSameCurve) {
  Random random(6);
  const auto point = [&] { return random.Point(-1, 1); };
  BezierCurve quartic;
  BsplineCurve spline{3, {0, 0, 0, 0, 1, 3, 4, 4, 4, 4}, {}}, stretched = spline;
  for (int k = 0; k < 5; ++k) quartic.points.push_back(point());
  for (int k = 0; k < 6; ++k) spline.points.push_back(point());
  stretched.points = spline.points;
  for (double& knot : stretched.knots) knot = 7 + 0.5 * knot;
  const Eigen::Affine3d motion =
      Eigen::Translation3d(3, -7, 2) * Eigen::AngleAxisd(1.2, Vec3(1, -2, 2).normalized());
  for (const Curve& curve : {Curve(HermiteCurve{point(), point(), point(), point()}), Curve(quartic),
                             Curve(spline), Curve(RandomSegment(random, 3))}) {
    const Curve moved = Moved(curve, motion);
    const auto bezier = ToBezier(curve);
    EXPECT_EQ(bezier.ok(), !std::holds_alternative<BsplineCurve>(curve));  // that of three spans is none
    for (int k = 0; k < 20; ++k) {
      const double t = random.Unit();
      const CurveJet jet = Evaluate(curve, t), there = Evaluate(moved, t);
      const Vec3 curvature = CurvatureVector(jet);
      const double close = 1e-12 * (1 + curvature.norm()) * (1 + 1 / jet.d.squaredNorm());
      EXPECT_THAT(there.p, IsNear(motion * jet.p, 1e-14 * 10));
      EXPECT_THAT(CurvatureVector(there), IsNear(motion.linear() * curvature, close));
      if (!bezier.ok()) continue;
      const CurveJet back = Evaluate(Reversed(*bezier), 1 - t), high = Evaluate(Elevated(*bezier, 12), t);
      EXPECT_THAT(back.p, IsNear(jet.p, 1e-13));
      EXPECT_THAT(high.p, IsNear(jet.p, 1e-13));
      EXPECT_THAT(CurvatureVector(back), IsNear(curvature, 10 * close));
      EXPECT_THAT(CurvatureVector(high), IsNear(curvature, 10 * close));
    }
  }
  for (int k = 0; k < 20; ++k) {
    const double t = random.Unit();
    EXPECT_THAT(Evaluate(spline, t).p, IsNear(Evaluate(stretched, t).p, 1e-14));
    EXPECT_THAT(Evaluate(spline, t).dd, IsNear(Evaluate(stretched, t).dd, 1e-11));
  }
}

TEST(Curve, ReversedAndElevatedAreTheSameCurve) {
  Random random(5);
  const HermiteCurve h{random.Point(-1, 1), random.Point(-1, 1), random.Point(-1, 1), random.Point(-1, 1)};
  const BezierCurve b = ToBezier(h), high = Elevated(b, 11);
  EXPECT_EQ(high.degree(), 11);
  for (int k = 0; k < 20; ++k) {
    const double t = random.Unit();
    EXPECT_THAT(Evaluate(h, t).p, IsNear(Evaluate(Reversed(h), 1 - t).p, 1e-15));
    EXPECT_THAT(Evaluate(b, t).d, IsNear(-Evaluate(Reversed(b), 1 - t).d, 1e-14));
    EXPECT_THAT(Evaluate(b, t).p, IsNear(Evaluate(high, t).p, 1e-15));
    EXPECT_THAT(Evaluate(b, t).dd, IsNear(Evaluate(high, t).dd, 1e-12));
  }
  const HermiteCurve back = HermiteOf(high);
  EXPECT_THAT(back.d0, IsNear(h.d0, 1e-14));
  EXPECT_THAT(back.d1, IsNear(h.d1, 1e-14));
}

}  // namespace
}  // namespace patchmill
