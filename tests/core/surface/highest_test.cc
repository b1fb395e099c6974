#include "core/surface/highest.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/surface/surface_models.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kProof = 1e-4;  // mm

double ToSegment(const Column& column, const Vec2& q) {
  const Vec2 d = column.b - column.a;
  const double l2 = d.squaredNorm();
  const double t = l2 > 0.0 ? std::clamp((q - column.a).dot(d) / l2, 0.0, 1.0) : 0.0;
  return (q - column.a - t * d).norm();
}

// The highest of a grid of points a piece in the column: no upper bound of the truth, but a lower one.
double HighestSample(const Surface& s, const Column& column, int cells) {
  double highest = -kInfinity;
  for (const Piece& piece : s.pieces) {
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells; ++j) {
        const Vec3 p = Position(piece, static_cast<double>(i) / cells, static_cast<double>(j) / cells);
        if (ToSegment(column, Xy(p)) < column.radius) highest = std::max(highest, p.z());
      }
    }
  }
  return highest;
}

// What every answer is, whatever the truth.
void ExpectHonest(const Surface& s, const Column& column, double above, const SurfacePoint& found) {
  ASSERT_LT(found.piece.index(), s.pieces.size());
  EXPECT_LT((Position(s.piece(found.piece), found.u, found.v) - found.p).norm(), 1e-11);
  EXPECT_LT(ToSegment(column, Xy(found.p)), column.radius);
  EXPECT_GT(found.p.z(), above);
}

class HighestOfEveryKind : public ::testing::TestWithParam<NamedModel> {};

TEST_P(HighestOfEveryKind, NoSampleIsHigher) {
  const Surface s = MakeSurface(GetParam().model);
  Random random(3);
  const double size = s.box.Diagonal() + 1.0;
  int in = 0;
  for (int n = 0; n < 40; ++n) {
    const Vec3 low = s.box.min, high = s.box.max;
    const auto anywhere = [&] {
      return Vec2(random.Uniform(low.x() - 0.1 * size, high.x() + 0.1 * size),
                  random.Uniform(low.y() - 0.1 * size, high.y() + 0.1 * size));
    };
    Column column;
    column.a = anywhere();
    column.b = n % 2 == 0 ? column.a : anywhere();
    column.radius = size * std::pow(10.0, random.Uniform(-2.0, -0.3));
    const auto found = HighestInColumn(s, column, -kInfinity, kProof);
    Column narrower = column;
    narrower.radius -= kProof;
    const double sample = HighestSample(s, narrower, 40);
    if (!found) {
      EXPECT_EQ(sample, -kInfinity);
      EXPECT_FALSE(AnyInColumn(s, column, -kInfinity, kProof));
      continue;
    }
    ++in;
    ExpectHonest(s, column, -kInfinity, *found);
    const double z = found->p.z();
    EXPECT_GE(z, sample - kProof);
    // Whether there is any: not above the highest, for sure below it.
    EXPECT_FALSE(AnyInColumn(s, narrower, z + kProof, kProof));
    EXPECT_FALSE(HighestInColumn(s, narrower, z + kProof, kProof));
    Column wider = column;
    wider.radius += 2.0 * kProof;
    EXPECT_TRUE(AnyInColumn(s, wider, z - 2.0 * kProof, kProof));
  }
  EXPECT_GT(in, 0);
}

INSTANTIATE_TEST_SUITE_P(All, HighestOfEveryKind, ::testing::ValuesIn(EveryKindOfPatch()),
                         [](const auto& test) { return test.param.name; });

TEST(Highest, OfASphereIsItsTopOrWhereTheColumnEnds) {
  const double r = 10.0;
  const Surface s = MakeSurface(Sphere(Vec3(1, 2, 3), r));
  for (const double radius : {0.1, 1.0, 4.0}) {
    for (double off = 0.0; off < r + radius; off += 0.37) {
      const Vec2 q(1.0 + off * 0.6, 2.0 + off * 0.8);
      const auto found = HighestInColumn(s, {q, q, radius}, -kInfinity, kProof);
      const double nearest = std::max(0.0, off - radius);  // in plan, from the sphere's axis
      ASSERT_TRUE(found) << radius << " " << off;
      const double truth = 3.0 + std::sqrt(r * r - nearest * nearest);
      EXPECT_LE(found->p.z(), truth + 1e-9);
      // The column that is narrower by the tolerance ends lower, steeply so beside the equator.
      const double inner = std::max(0.0, off - radius + kProof);
      if (inner > r) continue;
      EXPECT_GE(found->p.z(), 3.0 + std::sqrt(r * r - inner * inner) - kProof);
    }
  }
  const Vec2 beside(1.0 + r + 2.0, 2.0);
  EXPECT_FALSE(HighestInColumn(s, {beside, beside, 2.0 - 1e-3}, -kInfinity, kProof));
  EXPECT_TRUE(HighestInColumn(s, {beside, beside, 2.0 + 1e-3}, -kInfinity, kProof));
}

// Between the ends of a segment a slope is highest at the side, at the end by a half circle.
TEST(Highest, OfASlopeBesideASegment) {
  const double slope = 0.75;
  const Surface s = MakeSurface(Plane(50, 1.0, slope));
  const Column across{{-3, -4}, {-3, 5}, 2.0}, along{{-3, 1}, {6, 1}, 2.0};
  EXPECT_NEAR(HighestInColumn(s, across, -kInfinity, kProof)->p.z(), 1.0 + slope * -1.0, 2.0 * kProof);
  EXPECT_NEAR(HighestInColumn(s, along, -kInfinity, kProof)->p.z(), 1.0 + slope * 8.0, 2.0 * kProof);
  EXPECT_FALSE(AnyInColumn(s, along, 1.0 + slope * 8.0, kProof));
  EXPECT_TRUE(AnyInColumn(s, along, 1.0 + slope * 8.0 - 3.0 * kProof, kProof));
}

// A wall that the column almost touches along all its height, and a plateau at the very height asked about:
// nothing is looked at without end.
TEST(Highest, WallsAndPlateausAtTheLimitAreDecided) {
  const Surface s = MakeSurface(Block(10, 30, 40));
  for (const double gap : {-1e-3, -1e-5, -1e-9, 0.0, 1e-9, 1e-5, 1e-3}) {
    const Vec2 q(10.0 + 5.0 + gap, 3.0);
    const auto found = HighestInColumn(s, {q, q, 5.0}, -kInfinity, kProof);
    ASSERT_TRUE(found);
    if (gap < -kProof) {
      EXPECT_NEAR(found->p.z(), 30.0, 1e-9);
    }
    if (gap >= 0.0) {
      EXPECT_NEAR(found->p.z(), 0.0, 1e-9);
    }
    const bool higher = AnyInColumn(s, {q, q, 6.0}, 30.0 + gap, kProof);
    if (gap < -kProof || gap >= 0.0) {
      EXPECT_EQ(higher, gap < 0.0) << gap;
    }
  }
}

TEST(Highest, NonsenseFindsNothing) {
  const Surface s = MakeSurface(Plane(10));
  const Vec2 q(0, 0), bad(std::nan(""), 0);
  EXPECT_FALSE(AnyInColumn(s, {q, q, 0.0}, -1.0, kProof));
  EXPECT_FALSE(AnyInColumn(s, {q, q, -3.0}, -1.0, kProof));
  EXPECT_FALSE(AnyInColumn(s, {bad, q, 3.0}, -1.0, kProof));
  EXPECT_TRUE(AnyInColumn(s, {q, q, 3.0}, -1.0, 0.0));
}

}  // namespace
}  // namespace patchmill
