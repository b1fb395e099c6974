// How pieces continue over their sides.
#include "cam/path/zlevel/piece_sides.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/cam/path/zlevel/level_checks.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::MakeSurface;

// Counts sides by kind; the place across a side is the same place.
std::map<SideKind, int> Count(const Surface& surface) {
  const RunContext run(1);
  const PieceSides sides(surface, run);
  std::map<SideKind, int> count;
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    for (int side = 0; side < 4; ++side) {
      ++count[sides.At(PieceId(i), side).kind];
      for (const double t : {0.0, 0.3, 1.0}) {
        const Vec2 uv = SideParameters(side, t);
        const auto across = sides.Across(PieceId(i), side, t);
        if (!across) continue;
        EXPECT_NE(across->piece, PieceId(i));
        EXPECT_LE((across->p - Position(surface.pieces[i], uv.x(), uv.y())).norm(), 1e-9 * surface.scale);
      }
    }
  }
  return count;
}

TEST(ContourSides, BlockOnAFloor) {
  auto count = Count(MakeSurface(testing::Block(8.0, 5.0, 20.0)));
  // Floor: 8 patches in a ring with 8 smooth joints, 12 open outer sides, 4 against the walls.
  EXPECT_EQ(count[SideKind::kSmooth], 16);
  EXPECT_EQ(count[SideKind::kOpen], 12);
  EXPECT_EQ(count[SideKind::kCrease], 4 + 16 + 4);  // floor, walls, top
}

// A plane of one long patch and two short ones: smooth across the T-junction, from both sides.
TEST(ContourSides, TJunctionsAreSmooth) {
  const auto square = [](double x, double y, double height) {
    return testing::Single(
        BezierPatch{1, 1, {{x, y, 0}, {x, y + height, 0}, {x + 1, y, 0}, {x + 1, y + height, 0}}, {}});
  };
  auto count = Count(MakeSurface(testing::Join({square(0, 0, 2), square(1, 0, 1), square(1, 1, 1)})));
  EXPECT_EQ(count[SideKind::kSmooth], 1 + 2 + 2);
  EXPECT_EQ(count[SideKind::kOpen], 7);
  EXPECT_EQ(count[SideKind::kCrease], 0);
}

TEST(ContourSides, SphereIsSmoothButForItsPoles) {
  auto count = Count(MakeSurface(testing::Sphere(Vec3::Zero(), 10.0)));
  EXPECT_EQ(count[SideKind::kSmooth], 24);
  EXPECT_EQ(count[SideKind::kOpen], 8);
  EXPECT_EQ(count[SideKind::kCrease], 0);
}

TEST(ContourSides, JointsInsideASplineAreSmooth) {
  auto count = Count(MakeSurface(testing::RandomBspline(1)));
  EXPECT_EQ(count[SideKind::kOpen], 4 * 6);
  EXPECT_EQ(count[SideKind::kSmooth], 4 * 36 - 4 * 6);
}

TEST(ContourSides, FullKnotsAreCreases) {
  auto count = Count(MakeSurface(testing::Single(testing::RandomKnots(1, 3, 3, false))));
  EXPECT_GT(count[SideKind::kCrease], 0);
  EXPECT_GT(count[SideKind::kSmooth], 0);
}

TEST(ContourSides, TrianglesArePiecesWithSmoothJoints) {
  auto count = Count(MakeSurface(testing::Single(testing::RandomTriangle(1, 4, false))));
  EXPECT_EQ(count[SideKind::kSmooth], 6);
  EXPECT_EQ(count[SideKind::kOpen], 6);
}

TEST(ContourSides, OutwardTangentsLeaveThePiece) {
  const Surface surface = MakeSurface(testing::Plane(10.0, 0.0, 0.5, 0.0));
  const Vec3 expected[4] = {
      {0, -1, 0}, Vec3(1, 0, 0.5).normalized(), {0, 1, 0}, -Vec3(1, 0, 0.5).normalized()};
  for (int side = 0; side < 4; ++side) {
    const auto out = OutwardTangent(surface, PieceId(0), side, 0.3);
    ASSERT_TRUE(out.has_value());
    EXPECT_LE((*out - expected[side]).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace patchmill
