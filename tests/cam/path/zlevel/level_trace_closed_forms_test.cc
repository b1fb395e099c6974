// One level of h as loops: shapes with closed forms, judged in plan to 1e-9 mm.
#include <chrono>

#include <gtest/gtest.h>

#include "tests/cam/path/zlevel/level_checks.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Block;
using testing::CornerCount;
using testing::LargestRadiusError;
using testing::SignedArea;
using testing::TracedModel;
using testing::WrongNodes;

constexpr double kR = 3.0;

TEST(ContourLevel, SphereIsOneCircle) {
  const TracedModel sphere(testing::Sphere(Vec3::Zero(), 10.0));
  for (const double c : {1.0, 6.0, 12.5, 12.999, 12.9999}) {
    SCOPED_TRACE(c);
    const LevelContours level = sphere.At(c);
    ASSERT_EQ(level.loops.size(), 1u);
    EXPECT_EQ(level.z, c);
    EXPECT_LE(LargestRadiusError(level.loops[0], Vec2::Zero(), std::sqrt(169.0 - c * c)), 1e-9);
    EXPECT_LT(SignedArea(level.loops[0]), 0.0);  // material inside, on the right: clockwise
    EXPECT_EQ(CornerCount(level), 0);
  }
  EXPECT_TRUE(sphere.At(13.0).loops.empty());
  EXPECT_TRUE(sphere.At(20.0).loops.empty());
  // Below the equator the shank runs along it.
  const LevelContours low = sphere.At(-4.0);
  ASSERT_EQ(low.loops.size(), 1u);
  EXPECT_LE(LargestRadiusError(low.loops[0], Vec2::Zero(), 13.0), 1e-9);
}

TEST(ContourLevel, TorusHasAnInnerAndAnOuterCircle) {
  const TracedModel torus(testing::Torus(Vec3::Zero(), 20.0, 6.0));
  for (const double c : {4.0, 8.999}) {
    SCOPED_TRACE(c);
    const LevelContours level = torus.At(c);
    ASSERT_EQ(level.loops.size(), 2u);
    const double half = std::sqrt(81.0 - c * c);
    for (const CutterPath& loop : level.loops) {
      const bool outer = SignedArea(loop) < 0.0;
      EXPECT_LE(LargestRadiusError(loop, Vec2::Zero(), outer ? 20.0 + half : 20.0 - half), 1e-9);
    }
    EXPECT_LT(SignedArea(level.loops[0]) * SignedArea(level.loops[1]), 0.0);
  }
  const LevelContours crest = torus.At(9.0);  // a circle of peaks: moved up, nothing there
  EXPECT_TRUE(crest.loops.empty());
}

TEST(ContourLevel, TwoSpheresMeetInTwoExactCorners) {
  const TracedModel spheres(testing::TwoSpheres(5.0, 10.0));
  // Discs of radius sqrt(64 - c^2) about x = +-5.
  for (const double c : {3.5, 5.0}) {
    SCOPED_TRACE(c);
    const LevelContours level = spheres.At(c);
    ASSERT_EQ(level.loops.size(), 1u);
    const double rho = std::sqrt(64.0 - c * c);
    ASSERT_EQ(CornerCount(level), 2);
    for (const CutterPoint& p : level.loops[0].points) {
      const double left = (Xy(p.center) - Vec2(-5, 0)).norm(), right = (Xy(p.center) - Vec2(5, 0)).norm();
      EXPECT_NEAR(std::min(left, right), rho, 1e-9);
      if (p.other_contact) {
        EXPECT_NEAR(p.center.x(), 0.0, 1e-9);
        EXPECT_NEAR(std::abs(p.center.y()), std::sqrt(rho * rho - 25.0), 1e-9);
      }
    }
  }
  // Above the saddle of h at c = sqrt(39): two circles.
  const LevelContours high = spheres.At(7.0);
  EXPECT_EQ(high.loops.size(), 2u);
  const LevelContours peaks = spheres.At(7.9);
  EXPECT_EQ(peaks.loops.size(), 2u);
  EXPECT_TRUE(spheres.At(8.0).loops.empty());
}

// Distance of q from the square |x|,|y| <= a, outside.
double SquareDistance(const Vec2& q, double a) {
  return std::hypot(std::max(0.0, std::abs(q.x()) - a), std::max(0.0, std::abs(q.y()) - a));
}

TEST(ContourLevel, BlockOnAFloorIsARoundedSquare) {
  const TracedModel block(Block(8.0, 5.0, 20.0));
  for (const double c : {3.5, 4.999, 6.5, 7.0}) {
    SCOPED_TRACE(c);
    const LevelContours level = block.At(c);
    ASSERT_EQ(level.loops.size(), 1u);
    const double rho = c <= 5.0 ? kR : std::sqrt(9.0 - (c - 5.0) * (c - 5.0));
    for (const CutterPoint& p : level.loops[0].points)
      EXPECT_NEAR(SquareDistance(Xy(p.center), 8.0), rho, 1e-9);
    const double area = 16.0 * 16.0 + 4.0 * 16.0 * rho + kPi * rho * rho;
    EXPECT_NEAR(SignedArea(level.loops[0]), -area, 0.005 * 90.0);
  }
  // On the floor itself, or a hair above it.
  const LevelContours floor = block.At(3.0);
  EXPECT_GE(floor.z, 3.0);
  EXPECT_LE(floor.z, 3.01);
  ASSERT_EQ(floor.loops.size(), 1u);
  for (const CutterPoint& p : floor.loops[0].points) EXPECT_NEAR(SquareDistance(Xy(p.center), 8.0), kR, 1e-9);
  EXPECT_TRUE(block.At(8.0).loops.empty());
}

// Just below a flat everything over it is forbidden, and that must not cost a cell per spot.
TEST(ContourLevel, LevelsCloselyBelowAFlatTop) {
  const TracedModel block(Block(8.0, 5.0, 20.0));
  for (const double c : {7.9, 7.99}) {
    SCOPED_TRACE(c);
    const LevelContours level = block.At(c);
    ASSERT_EQ(level.loops.size(), 1u);
    const double rho = std::sqrt(9.0 - (level.z - 5.0) * (level.z - 5.0));
    for (const CutterPoint& p : level.loops[0].points)
      EXPECT_NEAR(SquareDistance(Xy(p.center), 8.0), rho, 1e-9);
  }
}

// h over the plate z = slope x, |x|,|y| <= a: concave in the contact, so the best of interior and edges.
double PlateHeight(const Vec2& q, double slope, double a) {
  double best = -kInfinity;
  const auto add = [&](double px, double py) {
    const double d2 = (Vec2(px, py) - q).squaredNorm();
    if (std::abs(px) <= a + 1e-12 && std::abs(py) <= a + 1e-12 && d2 <= kR * kR * (1.0 + 1e-15))
      best = std::max(best, slope * px + std::sqrt(std::max(0.0, kR * kR - d2)));
  };
  const double s = slope / std::hypot(1.0, slope);
  add(q.x() + kR * s, q.y());
  for (const double y : {-a, a}) {
    const double r = std::sqrt(std::max(0.0, kR * kR - (q.y() - y) * (q.y() - y)));
    add(std::clamp(q.x() + r * s, -a, a), y);
  }
  for (const double x : {-a, a}) add(x, std::clamp(q.y(), -a, a));
  return best;
}

// To first order in plan: outside by 1e-9 the plate is out of reach, inside by 1e-9 it is not.
void CheckOnPlate(const LevelContours& level, double slope, double a) {
  for (const CutterPath& loop : level.loops) {
    for (const CutterPoint& p : loop.points) {
      const Vec2 q = Xy(p.center);
      const Vec2 out = (q - Xy(p.contact->p)).normalized();
      EXPECT_LE(PlateHeight(q + 1e-9 * out, slope, a), level.z + 1e-12) << q.transpose();
      EXPECT_GT(PlateHeight(q - 1e-9 * out, slope, a), level.z - 1e-12) << q.transpose();
    }
  }
}

TEST(ContourLevel, TiltedPlateWithOpenBorders) {
  const double slope = 0.4, a = 20.0;
  const TracedModel plate(testing::Plane(a, 0.0, slope, 0.0));
  for (const double c : {-4.0, 2.0, 5.0, 8.0, 10.9, 10.9999}) {
    SCOPED_TRACE(c);
    const LevelContours level = plate.At(c);
    ASSERT_EQ(level.loops.size(), 1u);
    CheckOnPlate(level, slope, a);
  }
  EXPECT_TRUE(plate.At(11.0).loops.empty());
}

// Up to 89.4 degrees: h touches far above the level, the deepest disc is that of the point beside it.
TEST(ContourLevel, WallsThatLeanBack) {
  const double a = 4.0;
  for (const double slope : {5.0, 20.0, 100.0}) {
    SCOPED_TRACE(slope);
    const TracedModel wall(testing::Plane(a, 0.0, slope, 0.0));
    for (const double c : {-0.5 * slope, 0.0, 0.3 * slope}) {
      const LevelContours level = wall.At(c);
      ASSERT_EQ(level.loops.size(), 1u);
      CheckOnPlate(level, slope, a);
      // On the wall itself x = (c - R sqrt(1 + slope^2)) / slope.
      const double x = (c - kR * std::hypot(1.0, slope)) / slope;
      int on_wall = 0;
      for (const CutterPoint& p : level.loops[0].points) on_wall += std::abs(p.center.x() - x) <= 1e-9;
      EXPECT_GT(on_wall, 10);
    }
  }
}

TEST(ContourLevel, GapsAsWideAsTheTool) {
  const auto walls = [](double gap) {
    const double g = 0.5 * gap;
    return testing::Join(
        {testing::Single(testing::Bilinear({-g, -10, 0}, {-g, 10, 0}, {-g, -10, 8}, {-g, 10, 8})),
         testing::Single(testing::Bilinear({g, -10, 0}, {g, 10, 0}, {g, -10, 8}, {g, 10, 8}))});
  };
  EXPECT_EQ(TracedModel(walls(2.0 * kR + 0.2)).At(5.0).loops.size(), 2u);  // the tool passes between
  EXPECT_EQ(TracedModel(walls(2.0 * kR - 1e-6)).At(5.0).loops.size(), 1u);
  // Narrower than the resolution: either answer, but free vertices and sound chords (checked by At).
  const std::size_t loops = TracedModel(walls(2.0 * kR + 1e-6)).At(5.0).loops.size();
  EXPECT_TRUE(loops == 1u || loops == 2u) << loops;
}

TEST(ContourLevel, PocketsAreCounterClockwise) {
  const TracedModel bowl(testing::Paraboloid(0.05, 15.0));
  // Inside the bowl the contact radius r obeys c = a r^2 + R / sqrt(1 + 4 a^2 r^2).
  const LevelContours level = bowl.At(6.0);
  ASSERT_EQ(level.loops.size(), 2u);
  int pockets = 0;
  for (const CutterPath& loop : level.loops) {
    if (SignedArea(loop) < 0.0) continue;
    ++pockets;
    double lo = 0.0, hi = 15.0;
    for (int i = 0; i < 200; ++i) {
      const double r = 0.5 * (lo + hi);
      (0.05 * r * r + kR / std::sqrt(1.0 + 0.01 * r * r) < 6.0 ? lo : hi) = r;
    }
    const double center = lo - kR * 0.1 * lo / std::sqrt(1.0 + 0.01 * lo * lo);
    EXPECT_LE(LargestRadiusError(loop, Vec2::Zero(), center), 1e-9);
  }
  EXPECT_EQ(pockets, 1);
}

TEST(ContourLevel, SignsOfRandomSplines) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    const TracedModel part(testing::RandomBspline(seed));
    for (const double c : {2.0, 4.0}) {
      const LevelContours level = part.At(c);
      EXPECT_EQ(WrongNodes(part.surface, kR, level, 0.02, 0.31), 0);
    }
  }
}

TEST(ContourLevel, SignsOfFoldedSplines) {
  for (const std::uint64_t seed : {4u, 5u}) {
    SCOPED_TRACE(seed);
    const TracedModel part(testing::RandomBspline(seed, {.folds = true, .rational = seed == 5}));
    const LevelContours level = part.At(3.0);
    EXPECT_EQ(WrongNodes(part.surface, kR, level, 0.02, 0.37), 0);
  }
}

TEST(ContourLevel, SignsOfTheBumpyPart) {
  const TracedModel part(testing::Bumpy());
  for (const double c : {0.0, 4.5}) {
    SCOPED_TRACE(c);
    const LevelContours level = part.At(c, part.params.resolution / 8.0);
    EXPECT_GT(level.loops.size(), 10u);
    EXPECT_LE(WrongNodes(part.surface, kR, level, 0.02, 0.53), 0);
  }
}

TEST(ContourLevel, SameTwice) {
  const TracedModel part(testing::RandomBspline(7));
  const RunContext run;
  const LevelContours a = TraceLevel(part.locator, 3.0, part.params, run);
  const LevelContours b = TraceLevel(part.locator, 3.0, part.params, run);
  ASSERT_EQ(a.loops.size(), b.loops.size());
  for (std::size_t i = 0; i < a.loops.size(); ++i) {
    ASSERT_EQ(a.loops[i].points.size(), b.loops[i].points.size());
    for (std::size_t k = 0; k < a.loops[i].points.size(); ++k)
      EXPECT_EQ(a.loops[i].points[k].center, b.loops[i].points[k].center);
  }
}

TEST(ContourLevel, CancelStopsAtOnce) {
  const TracedModel part(testing::Bumpy());
  RunContext run;
  run.Cancel();
  const auto start = std::chrono::steady_clock::now();
  TraceLevel(part.locator, 0.0, part.params, run);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(200));
}

}  // namespace
}  // namespace patchmill
