// MaxHeight and SweptGouge: closed forms and sampled truth.
#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "cam/location/swept_ball.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;
using testing::SurfaceOf;

// Largest h near the rectangle with these corners by samples: never above the truth.
double SampledMaximum(const Locator& locator, const Vec2& a, const Vec2& b, double half_width, int n) {
  const Vec2 low = a.cwiseMin(b), high = a.cwiseMax(b);
  double best = -kInfinity;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const Vec2 share(double(i) / n, double(j) / n);
      const Vec2 q =
          low.array() - half_width + share.array() * (high - low).array() + share.array() * 2.0 * half_width;
      if ((q - q.cwiseMax(low).cwiseMin(high)).norm() > half_width) continue;
      if (const auto h = locator.Height(q)) best = std::max(best, h->z);
    }
  }
  return best;
}

TEST(MaxHeight, OfAPlaneAndNothing) {
  const double sx = 0.5;
  const Surface surface = SurfaceOf(testing::Plane(30.0, 1.0, sx, 0.0));
  const Locator locator(surface, 3.0);
  const double truth = 1.0 + sx * 12.0 + 3.0 * std::sqrt(1 + sx * sx);  // highest at x = 10 + 2
  const double got = locator.MaxHeight({-5, 3}, {10, -4}, 2.0, 0.01);
  EXPECT_GE(got, truth - 1e-9);
  EXPECT_LE(got, truth + 0.01);
  EXPECT_EQ(locator.MaxHeight({100, 0}, {120, 0}, 5.0), -kInfinity);
  // The corner counts, not only the way straight from end to end.
  const double corner = 1.0 + sx * 12.0 + 3.0 * std::sqrt(1 + sx * sx);
  EXPECT_NEAR(locator.MaxHeight({10, 3}, {-5, -40}, 2.0, 0.01), corner, 0.01);
  // One that just reaches the border.
  EXPECT_GT(locator.MaxHeight({35.9, 0}, {50, 0}, 3.0), -kInfinity);
  EXPECT_EQ(locator.MaxHeight({36.1, 0}, {50, 0}, 3.0), -kInfinity);
}

TEST(MaxHeight, IsAboveAllSamplesAndTight) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Surface surface = SurfaceOf(testing::RandomBspline(seed));
    const Locator locator(surface, 2.0);
    Random random(seed);
    for (int i = 0; i < 8; ++i) {
      const Vec2 a(random.Uniform(0, 40), random.Uniform(0, 40)),
          b(random.Uniform(0, 40), random.Uniform(0, 40));
      const double w = i % 3 == 0 ? 0.0 : random.Uniform(0.0, 4.0);
      const double bound = locator.MaxHeight(a, b, w, 0.02);
      const double sampled = SampledMaximum(locator, a, b, w, 60);
      EXPECT_GE(bound, sampled - 1e-9);
      EXPECT_LE(bound, sampled + 0.02 + 0.1) << "seed " << seed;  // 0.1: what 60 samples a side may miss
    }
  }
}

TEST(SweptGouge, AlongAPlane) {
  const Surface surface = SurfaceOf(testing::Plane(30.0, 1.0, 0.3, -0.2));
  const double r = 3.0, secant = std::sqrt(1 + 0.3 * 0.3 + 0.2 * 0.2);
  const Locator locator(surface, r);
  const auto above = [&](double x, double y, double gap) {
    return Vec3(x, y, 1.0 + 0.3 * x - 0.2 * y + (r + gap) * secant);
  };
  for (const double gap : {0.5, 0.0, -0.01, -0.3}) {
    const double got = locator.SweptGouge(above(-10, 3, gap), above(12, -8, gap), 1e-6);
    EXPECT_NEAR(got, std::max(0.0, -gap), 1.1e-6) << gap;
  }
  // One end deeper than the other: the deeper one counts.
  EXPECT_NEAR(locator.SweptGouge(above(-10, 3, -0.1), above(12, -8, -0.2), 1e-6), 0.2, 1.1e-6);
}

TEST(SweptGouge, TheShankCounts) {
  // The ball passes below the top of a block: everything above it is cut.
  const Surface surface = SurfaceOf(testing::Block(10.0, 8.0, 40.0));
  const Locator locator(surface, 3.0);
  EXPECT_NEAR(locator.SweptGouge({12.5, -30, 3.0}, {12.5, 30, 3.0}, 1e-6), 0.5, 1e-5);
  EXPECT_NEAR(locator.SweptGouge({13.0, -30, 3.0}, {13.0, 30, 3.0}, 1e-6), 0.0, 1e-5);
  EXPECT_NEAR(locator.SweptGouge({13.0, -30, 2.75}, {13.0, 30, 2.75}, 1e-6), 0.25, 1e-5);
  EXPECT_NEAR(locator.SweptGouge({0, 0, 11.0}, {0, 0, 10.5}, 1e-6), 0.5, 1e-5);  // a vertical move
}

TEST(SweptGouge, ChordBetweenFreeCentresNeverBeyondT2) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Surface surface = SurfaceOf(testing::RandomBspline(seed));
    const double r = 3.0;
    const Locator locator(surface, r);
    Random random(seed);
    for (int i = 0; i < 40; ++i) {
      const Vec2 a(random.Uniform(2, 38), random.Uniform(2, 38));
      const double length = random.Uniform(0.05, 1.5), phi = random.Uniform(0, 2 * kPi);
      const Vec2 b = a + length * Vec2(std::cos(phi), std::sin(phi));
      const auto ha = locator.Height(a), hb = locator.Height(b);
      if (!ha || !hb) continue;
      const Vec3 ca = Lift(a, ha->z), cb = Lift(b, hb->z);
      const double chord = (cb - ca).norm();
      if (chord > 2 * r) continue;
      EXPECT_LE(locator.SweptGouge(ca, cb, 1e-5), r - std::sqrt(r * r - 0.25 * chord * chord) + 1.1e-5);
    }
  }
}

TEST(SweptGouge, GougeWithinIsItsComparison) {
  int within = 0, beyond = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Surface surface = SurfaceOf(testing::RandomBspline(seed));
    const Locator locator(surface, 3.0);
    Random random(seed);
    for (int i = 0; i < 60; ++i) {
      const Vec2 a(random.Uniform(2, 38), random.Uniform(2, 38));
      const Vec2 b = a + Vec2(random.Uniform(-2, 2), random.Uniform(-2, 2));
      const Vec3 ca = Lift(a, locator.Height(a)->z), cb = Lift(b, locator.Height(b)->z);
      const double gouge = locator.SweptGouge(ca, cb, 1e-6);
      for (const double limit : {0.5 * gouge, gouge - 1e-3, gouge + 1e-3, 2.0 * gouge + 1e-3, 0.0}) {
        if (limit < 0.0) continue;
        const bool got = locator.GougeWithin(ca, cb, limit, 1e-4);
        if (gouge <= limit - 1e-4) {
          EXPECT_TRUE(got);
          ++within;
        } else if (gouge > limit + 1e-6) {
          EXPECT_FALSE(got);
          ++beyond;
        }
      }
    }
  }
  EXPECT_GT(within, 100);
  EXPECT_GT(beyond, 100);
}

// The proof by leaves against the value, which knows nothing of it: random moves near and through every kind
// of surface, short and long, level, steep and vertical, at limits on both sides of the truth.
void CompareLimits(const PatchModel& model, double radius, std::uint64_t seed, int moves, int& within,
                   int& beyond) {
  const Surface surface = SurfaceOf(model);
  const Locator locator(surface, radius);
  Random random(seed);
  const Box3& box = surface.box;
  for (int i = 0; i < moves; ++i) {
    const auto centre = [&](const Vec2& q) -> std::optional<Vec3> {
      const auto h = locator.Height(q);
      if (!h) return std::nullopt;
      return Lift(q, h->z + (i % 3 == 0 ? random.Uniform(-0.2, 0.1) * radius : 0.0));
    };
    const double margin = 0.9 * radius;
    const Vec2 q(random.Uniform(box.min.x() - margin, box.max.x() + margin),
                 random.Uniform(box.min.y() - margin, box.max.y() + margin));
    const double length = radius * std::pow(10.0, random.Uniform(-3.0, 0.7)),
                 phi = random.Uniform(0, 2 * kPi);
    const auto a = centre(q);
    auto b = i % 11 == 0 ? a : centre(q + length * Vec2(std::cos(phi), std::sin(phi)));
    if (!a || !b) continue;
    if (i % 11 == 0) b->z() += random.Uniform(-0.1, 0.1) * radius;
    const double gouge = locator.SweptGouge(*a, *b, 1e-7);
    for (const double limit : {0.7 * gouge, gouge - 1e-4, gouge + 1e-4, 1.3 * gouge + 1e-4, 1e-5}) {
      if (limit < 0.0) continue;
      const bool got = locator.GougeWithin(*a, *b, limit, 1e-5);
      if (gouge <= limit - 1e-5) {
        ASSERT_TRUE(got) << "seed " << seed << " move " << i << " limit " << limit << " gouge " << gouge;
        ++within;
      } else if (gouge > limit + 1e-7) {
        ASSERT_FALSE(got) << "seed " << seed << " move " << i << " limit " << limit << " gouge " << gouge;
        ++beyond;
      }
    }
  }
}

TEST(SweptGouge, LimitsOnEveryKindOfSurface) {
  int within = 0, beyond = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const bool folds = seed % 2 == 1;
    CompareLimits(testing::RandomBspline(seed, {.folds = folds, .rational = seed % 3 == 0}), 3.0, seed, 60,
                  within, beyond);
    CompareLimits(testing::Single(testing::RandomGregory(seed, GregoryPatch::Blend::kCorner)), 2.0, seed, 60,
                  within, beyond);
    CompareLimits(testing::Single(testing::RandomTriangle(seed, 3, folds)), 2.0, seed, 40, within, beyond);
    CompareLimits(testing::Single(testing::RandomKnots(seed, 3, 2, folds)), 2.0, seed, 40, within, beyond);
  }
  CompareLimits(testing::Block(8.0, 6.0, 20.0), 3.0, 7, 100, within, beyond);
  CompareLimits(testing::TwoPlanes(Radians(50), 15.0), 3.0, 8, 100, within, beyond);
  CompareLimits(testing::TwoPlanes(Radians(-50), 15.0), 3.0, 9, 100, within, beyond);
  CompareLimits(testing::Sphere(Vec3(0, 0, 0), 8.0), 3.0, 10, 100, within, beyond);
  CompareLimits(testing::Torus(Vec3(0, 0, 0), 7.0, 4.0), 3.0, 11, 100, within, beyond);
  CompareLimits(testing::ParabolicValley(0.5 / 3.0, 10.0), 3.0, 12, 100, within, beyond);
  CompareLimits(testing::Cylinder(Vec3(0, 0, 0), 6.0, 10.0), 3.0, 13, 100, within, beyond);
  EXPECT_GT(within, 2000);
  EXPECT_GT(beyond, 1000);
}

TEST(SweptBall, TwoDistancesBoundTheWholeSegmentSharply) {
  Random random(5);
  double sharpest = kInfinity;
  for (int i = 0; i < 100000; ++i) {
    const double length = random.Uniform(0.01, 3.0);
    const Vec3 a(0, 0, 0), b(length, 0, 0), p = random.Point(-3.0, 3.0);
    const double bound = internal::ChordDistance2(p.squaredNorm(), (p - b).squaredNorm(), length);
    const double t = std::clamp(p.x(), 0.0, length);
    const double truth = (p - Vec3(t, 0, 0)).squaredNorm();
    // For one point the bound is attained; larger distances than its own never have a larger bound.
    ASSERT_NEAR(bound, truth, 1e-12);
    const double less0 = random.Unit(), less1 = random.Unit();
    const double weaker =
        internal::ChordDistance2(less0 * p.squaredNorm(), less1 * (p - b).squaredNorm(), length);
    ASSERT_LE(weaker, truth + 1e-12);
    sharpest = std::min(sharpest, truth - weaker);
  }
  EXPECT_LT(sharpest, 1e-2);
}

TEST(SweptGouge, AgreesWithSampledPoints) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const PatchModel model = testing::RandomBspline(seed);
    const Surface surface = SurfaceOf(model);
    const double r = 2.5;
    const Locator locator(surface, r);
    Random random(seed);
    std::vector<Vec3> points;
    for (int i = 0; i <= 250; ++i) {
      for (int j = 0; j <= 250; ++j) points.push_back(Position(model.patches[0].shape, i / 250.0, j / 250.0));
    }
    for (int i = 0; i < 10; ++i) {
      const Vec3 a(random.Uniform(0, 40), random.Uniform(0, 40), random.Uniform(2, 7));
      const Vec3 b(random.Uniform(0, 40), random.Uniform(0, 40), random.Uniform(2, 7));
      double sampled = 0.0;
      for (const Vec3& p : points) {  // nearest of many points of the swept set, in place of a formula
        const Vec2 d = Xy(b) - Xy(a);
        const double t0 = std::clamp((Xy(p) - Xy(a)).dot(d) / d.squaredNorm(), 0.0, 1.0);
        if ((Xy(a) + t0 * d - Xy(p)).norm() > r) continue;
        double nearest = kInfinity;
        for (int k = -40; k <= 40; ++k) {
          const double t = std::clamp(t0 + k * 0.5 * r / 40.0 / d.norm(), 0.0, 1.0);
          const Vec3 c = a + t * (b - a);
          nearest = std::min(nearest, (p - Vec3(c.x(), c.y(), std::max(c.z(), p.z()))).norm());
        }
        sampled = std::max(sampled, r - nearest);
      }
      const double got = locator.SweptGouge(a, b, 1e-4);
      EXPECT_GE(got, sampled - 2e-3);
      EXPECT_LE(got, sampled + 0.05);  // spacing of the samples
    }
  }
}

}  // namespace
}  // namespace patchmill
