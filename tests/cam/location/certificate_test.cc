// The certificate closes, and at any gap the height is the same, where searches have it hard: at open
// borders, near contacts about to leave the disc, at patch borders, at switches, where the ball just fits.
#include <cmath>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "tests/support/clock.h"
#include "tests/support/random.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;
using testing::SurfaceOf;

struct Tally {
  long queries = 0;
  long open_gaps = 0;  // certificates that did not close to eps
};

void Query(const Locator& locator, const Vec2& q, double eps, Tally& tally) {
  const auto h = locator.Height(q);
  const auto c = locator.CertifiedHeight(q, eps, h ? &h->contact : nullptr);
  ++tally.queries;
  ASSERT_EQ(h.has_value(), c.has_value()) << q.transpose();
  if (!h) return;
  ASSERT_NEAR(h->z, c->z, 1e-9) << q.transpose();
  ASSERT_GE(c->gap, 0.0);
  tally.open_gaps += c->gap > eps + 1e-9;
}

// Queries at random places, then around points of the surface's patch borders: under the tool's centre, and
// at a distance of R +- a little, where the border is about to come into or leave the disc.
void Fuzz(const PatchModel& model, double radius, int count, std::uint64_t seed, Tally& tally) {
  const Surface surface = SurfaceOf(model);
  const Locator locator(surface, radius);
  Random random(seed);
  const Box3& box = surface.box;
  for (int i = 0; i < count; ++i) {
    const double eps = i % 5 == 0 ? 1e-6 : 1e-4;
    if (i % 3 == 0) {
      const Vec2 q(random.Uniform(box.min.x() - radius, box.max.x() + radius),
                   random.Uniform(box.min.y() - radius, box.max.y() + radius));
      Query(locator, q, eps, tally);
    } else {
      const Piece& piece =
          surface.pieces[static_cast<std::size_t>(random.Int(static_cast<int>(surface.pieces.size())))];
      double u = random.Unit(), v = random.Unit();
      (random.Int(2) == 0 ? u : v) = random.Int(2);
      const Vec3 p = Position(piece, u, v);
      const double phi = random.Uniform(0, 2 * kPi), tiny = std::pow(10.0, random.Uniform(-9.0, -1.0));
      const double sign = random.Int(2) == 0 ? 1.0 : -1.0;
      const double distance = i % 3 == 1 ? tiny : radius + sign * tiny;
      Query(locator, Xy(p) + distance * Vec2(std::cos(phi), std::sin(phi)), eps, tally);
    }
    if (::testing::Test::HasFatalFailure()) return;
  }
}

void ExpectClosed(const Tally& tally, long at_least) {
  EXPECT_GE(tally.queries, at_least);
  EXPECT_EQ(tally.open_gaps, 0) << "of " << tally.queries;
}

TEST(Certificate, RandomSplines) {
  Tally tally;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Fuzz(testing::RandomBspline(seed), 3.0, 2000, seed, tally);
  }
  ExpectClosed(tally, 40000);
}

TEST(Certificate, FoldedAndRationalSplines) {
  Tally tally;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    testing::RandomBsplineParams params;
    params.folds = true;
    params.rational = seed % 2 == 0;
    Fuzz(testing::RandomBspline(seed, params), 2.5, 1500, seed, tally);
  }
  ExpectClosed(tally, 15000);
}

TEST(Certificate, GregoryQuadsAndTriangles) {
  Tally tally;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    for (const auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
      Fuzz(testing::Single(testing::RandomGregory(seed, blend)), 2.0, 1000, seed, tally);
    }
    for (int degree = 2; degree <= 5; ++degree) {
      Fuzz(testing::Single(testing::RandomTriangle(seed, degree, seed % 2 == 0)), 2.0, 500, seed, tally);
    }
  }
  ExpectClosed(tally, 20000);
}

TEST(Certificate, ShapesWithPolesWallsAndCreases) {
  Tally tally;
  Fuzz(testing::Sphere(Vec3(0, 0, 0), 8.0), 3.0, 5000, 1, tally);
  Fuzz(testing::Torus(Vec3(0, 0, 0), 10.0, 4.0), 3.0, 5000, 2, tally);
  Fuzz(testing::Torus(Vec3(0, 0, 0), 7.0, 4.0), 3.0, 3000, 3, tally);  // the ball just fits the hole
  Fuzz(testing::TwoSpheres(6.0, 10.0), 3.0, 4000, 4, tally);
  Fuzz(testing::Block(8.0, 6.0, 20.0), 3.0, 6000, 5, tally);
  Fuzz(testing::TwoPlanes(Radians(50), 15.0), 3.0, 3000, 6, tally);
  Fuzz(testing::Cylinder(Vec3(0, 0, 0), 6.0, 10.0), 3.0, 3000, 7, tally);
  ExpectClosed(tally, 29000);
}

TEST(Certificate, WhereTheBallJustFits) {
  // 2 a R = 1 at the bottom: flat maxima, the hardest place for Newton and for convexity.
  Tally tally;
  Fuzz(testing::ParabolicValley(0.5 / 3.0, 10.0), 3.0, 2000, 8, tally);
  Fuzz(testing::Paraboloid(0.5 / 3.0, 10.0), 3.0, 2000, 9, tally);
  Fuzz(testing::ParabolicValley(0.5 / 3.0 * 1.0001, 10.0), 3.0, 2000, 10, tally);
  const Surface surface = SurfaceOf(testing::ParabolicValley(0.5 / 3.0, 10.0));
  const Locator locator(surface, 3.0);
  Random random(11);
  for (int i = 0; i < 2000; ++i) {
    Query(locator, {random.Uniform(-1, 1) * std::pow(10.0, random.Uniform(-8, 0)), random.Uniform(-9, 9)},
          1e-6, tally);
  }
  ExpectClosed(tally, 8000);
}

// A floor, a fillet of exactly the ball's radius, a wall: all along the fillet the ball touches at once where
// it meets the wall, and nothing but division can prove it. Common in drawings, so it must not take long.
TEST(Certificate, AFilletOfTheBallsRadius) {
  constexpr double kR = 3.0, kX = 20.0, kLength = 40.0, kTop = 12.0;
  const double w = std::sqrt(0.5);
  BezierPatch fillet{2, 1, {}, {1.0, 1.0, w, w, 1.0, 1.0}};
  for (const Vec2& p : {Vec2(kX, 0.0), Vec2(kX + kR, 0.0), Vec2(kX + kR, kR)}) {
    for (const double y : {0.0, kLength}) fillet.points.emplace_back(p.x(), y, p.y());
  }
  PatchModel model;
  model.patches = {{"", testing::Bilinear({0, 0, 0}, {kX, 0, 0}, {0, kLength, 0}, {kX, kLength, 0})},
                   {"", fillet},
                   {"", testing::Bilinear({kX + kR, 0, kR}, {kX + kR, kLength, kR}, {kX + kR, 0, kTop},
                                          {kX + kR, kLength, kTop})}};
  const Surface surface = SurfaceOf(std::move(model));
  const Locator locator(surface, kR);
  Random random(12);
  const double start = testing::ClockSeconds(CLOCK_THREAD_CPUTIME_ID);
  for (int i = 0; i < 1000; ++i) {
    const double off = std::pow(10.0, random.Uniform(-9.0, -4.0));
    const Vec2 q(kX - off, random.Uniform(kR, kLength - kR));
    const auto h = locator.CertifiedHeight(q, 1e-6);
    ASSERT_TRUE(h.has_value());
    EXPECT_NEAR(h->z, kR, 1e-9) << off;
    EXPECT_LE(h->gap, 1e-6) << off;
    EXPECT_TRUE(locator.Free(Lift(q, kR + 2e-6))) << off;
    EXPECT_FALSE(locator.Free(Lift(q, kR - 2e-6))) << off;
  }
  EXPECT_LT(testing::ClockSeconds(CLOCK_THREAD_CPUTIME_ID) - start, testing::kSanitized ? 60.0 : 4.0);
}

TEST(Certificate, HeightIsTheMaximumOverNeighboursContacts) {
  // [location (1)]: the branch of any contact is a lower bound of h everywhere.
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Surface surface = SurfaceOf(testing::RandomBspline(seed));
    const double r = 3.0;
    const Locator locator(surface, r);
    Random random(seed);
    for (int i = 0; i < 2000; ++i) {
      const Vec2 a(random.Uniform(0, 40), random.Uniform(0, 40));
      const Vec2 b = a + Vec2(random.Uniform(-2, 2), random.Uniform(-2, 2));
      const auto ha = locator.Height(a), hb = locator.Height(b);
      ASSERT_TRUE(ha.has_value());
      const double rim = r * r - (Xy(ha->contact.p) - b).squaredNorm();
      if (rim < 0.0) continue;
      ASSERT_TRUE(hb.has_value());
      EXPECT_GE(hb->z, ha->contact.p.z() + std::sqrt(rim) - 1e-9);
    }
  }
}

}  // namespace
}  // namespace patchmill
