// Lines that bend to keep their steps even: shorter, as fine everywhere, within their angle, and straight
// where nothing is gained.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/parallel/line_shape.h"
#include "cam/path/parallel/zigzag_paths.h"
#include "core/diffgeo/forms.h"
#include "tests/support/joined_surface.h"
#include "tests/support/leftover.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

ZigzagParams BendParams(double bend_degrees, double angle = 0.0) {
  ZigzagParams params;
  params.pass.scallop = 0.02;
  params.pass.chord_tolerance = 0.005;
  params.pass.window.max = Radians(60);
  params.angle = angle;
  params.max_bend = Radians(bend_degrees);
  return params;
}

std::vector<CutterPath> Lines(const Locator& locator, const ZigzagParams& params) {
  auto paths = ZigzagPaths(locator, params, RunContext(2));
  EXPECT_TRUE(paths.ok()) << paths.status();
  return *std::move(paths);
}

// rad: how far the moves turn from the lines' angle in plan.
double FarthestTurn(const std::vector<CutterPath>& paths, double angle) {
  const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
  double turn = 0.0;
  for (const CutterPath& path : paths) {
    for (std::size_t i = 1; i < path.points.size(); ++i) {
      const Vec2 d = Xy(path.points[i].center - path.points[i - 1].center);
      if (d.norm() > 1e-3) turn = std::max(turn, std::atan2(std::abs(d.dot(across)), d.dot(along)));
    }
  }
  return turn;
}

class BentOverHills : public ::testing::TestWithParam<double> {};

TEST_P(BentOverHills, ShorterAsFineAndWithinTheAngle) {
  const double angle = GetParam(), bend = 20.0;
  const Surface surface = JoinedSurface(TwoHills());
  const Locator locator(surface, 3.0);
  const auto straight = Lines(locator, BendParams(0.0, angle));
  const auto bent = Lines(locator, BendParams(bend, angle));
  EXPECT_LT(FarthestTurn(straight, angle), 1e-6);
  EXPECT_LE(FarthestTurn(bent, angle), Radians(bend) + 1e-6);
  EXPECT_GT(FarthestTurn(bent, angle), Radians(5.0));
  EXPECT_LT(TotalLength(bent), 0.96 * TotalLength(straight));

  const DistanceToPaths distance(bent);
  Random random(11);
  double worst = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const PieceId piece(random.Int(static_cast<int>(surface.pieces.size())));
    const SurfaceJet jet = Evaluate(surface, piece, random.Uniform(0, 1), random.Uniform(0, 1));
    const Vec3 e = *UpwardNormal(jet);
    if (!locator.Free(jet.p + 3.0 * e, 1e-7)) continue;
    // Along slanting borders rest passes have the last word.
    if ((Xy(jet.p) - Vec2(50, 50)).cwiseAbs().maxCoeff() > 49.0) continue;
    worst = std::max(worst, distance.At(jet.p, 4.0) - 3.0);
  }
  EXPECT_LE(worst, 0.02 + 0.005);
  EXPECT_GE(worst, 0.015);
}

INSTANTIATE_TEST_SUITE_P(Angles, BentOverHills, ::testing::Values(0.0, kPi / 2.0, 0.4, 2.35));

// Lines bend only for 4 %, from fine finishes to coarse ones.
TEST(LineBends, AreShorterByWhatTheyAreAskedFor) {
  const Surface surface = JoinedSurface(TwoHills());
  const Locator locator(surface, 3.0);
  for (const double scallop : {0.01, 0.03, 0.1, 0.2}) {
    ZigzagParams straight = BendParams(0.0), bent = BendParams(20.0);
    straight.pass.scallop = bent.pass.scallop = scallop;
    EXPECT_LT(TotalLength(Lines(locator, bent)), 0.96 * TotalLength(Lines(locator, straight))) << scallop;
  }
}

// Where the surface changes over a few steps, the lattice promises a saving that the lines do not reach.
TEST(LineBends, AreNotLongerThanStraightOnBusySurface) {
  double bent = 0.0, straight = 0.0;
  int straighter = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Surface surface = JoinedSurface(RandomBspline(seed, {.spans = 5, .size = 40.0, .amplitude = 3.0}));
    const Locator locator(surface, 3.0);
    for (const double scallop : {0.02, 0.1}) {
      ZigzagParams params = BendParams(0.0);
      params.pass.scallop = scallop;
      const double plain = TotalLength(Lines(locator, params));
      params.max_bend = Radians(20.0);
      const double bending = TotalLength(Lines(locator, params));
      EXPECT_LT(bending, 1.01 * plain) << "seed " << seed << ", scallop " << scallop;
      bent += bending;
      straight += plain;
      straighter += bending == plain;
    }
  }
  EXPECT_LE(bent, 1.001 * straight);
  EXPECT_GT(straighter, 0);
}

void ExpectTheSameAsStraight(const PatchModel& model) {
  const Surface surface = JoinedSurface(model);
  const Locator locator(surface, 3.0);
  const auto straight = Lines(locator, BendParams(0.0)), bent = Lines(locator, BendParams(20.0));
  ASSERT_EQ(straight.size(), bent.size());
  for (std::size_t i = 0; i < bent.size(); ++i) {
    ASSERT_EQ(straight[i].points.size(), bent[i].points.size());
    for (std::size_t k = 0; k < bent[i].points.size(); ++k)
      EXPECT_EQ(straight[i].points[k].center, bent[i].points[k].center);
  }
}

TEST(LineBends, StraightWhereStepsAreEvenAlongALine) {
  ExpectTheSameAsStraight(Plane(10));
  ExpectTheSameAsStraight(Plane(10, 0, 0.5, -0.3));
  ExpectTheSameAsStraight(Sphere(Vec3::Zero(), 20, Half::kUpper));
  ExpectTheSameAsStraight(Cylinder(Vec3::Zero(), 15, 10, Half::kUpper));
}

TEST(LineShape, IsStraightBetweenItsKnots) {
  const LineShape line{2.0, 0.5, {1.0, 2.0, 2.0, 0.0}};
  EXPECT_EQ(line.At(-10.0), 1.0);
  EXPECT_EQ(line.At(2.0), 1.0);
  EXPECT_DOUBLE_EQ(line.At(2.25), 1.5);
  EXPECT_EQ(line.At(2.75), 2.0);
  EXPECT_DOUBLE_EQ(line.At(3.25), 1.0);
  EXPECT_EQ(line.At(3.5), 0.0);
  EXPECT_EQ(line.At(10.0), 0.0);
  EXPECT_EQ(line.SlopeAt(1.0), 0.0);
  EXPECT_EQ(line.SlopeAt(2.1), 2.0);
  EXPECT_EQ(line.SlopeAt(2.6), 0.0);
  EXPECT_EQ(line.SlopeAt(3.1), -4.0);
  EXPECT_EQ(line.SlopeAt(3.6), 0.0);
  EXPECT_EQ(LineShape::Straight(7.0).At(-3.0), 7.0);
}

TEST(LineShape, CornersAreItsEndsAndTheKnotsWhereItTurns) {
  const LineShape line{0.0, 1.0, {1.0, 2.0, 3.0, 3.0}};
  EXPECT_EQ(CornersOf(line, -1.0, 5.0), (std::vector<double>{-1.0, 0.0, 2.0, 5.0}));
  EXPECT_EQ(CornersOf(line, 0.5, 1.5), (std::vector<double>{0.5, 1.5}));
  EXPECT_EQ(CornersOf(LineShape::Straight(2.0), 0.0, 1.0), (std::vector<double>{0.0, 1.0}));
}

TEST(LineShape, BetweenTwoLiesTheirShare) {
  const LineShape a{0.0, 1.0, {0.0, 0.0, 4.0}}, b{0.0, 1.0, {4.0, 8.0, 4.0}};
  const LineShape line = Between(a, b, 0.25);
  EXPECT_EQ(line.y, (std::vector<double>{1.0, 2.0, 4.0}));
  EXPECT_EQ(Between(LineShape::Straight(0.0), b, 0.5).y, (std::vector<double>{2.0, 4.0, 2.0}));
  EXPECT_EQ(Between(a, LineShape::Straight(2.0), 0.5).y, (std::vector<double>{1.0, 1.0, 3.0}));
}

}  // namespace
}  // namespace patchmill
