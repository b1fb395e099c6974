// The test shapes that are not exact quadrics: what other tests lean on.
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include "core/patch/piece.h"
#include "tests/support/random.h"

namespace patchmill::testing {
namespace {

TEST(InterpolatedHeights, MeetsTheFunctionAtTheKnots) {
  const PatchShape shape = InterpolatedHeights(BumpyHeight, -10, 50, 20, 40, 7, 5);
  for (int i = 0; i <= 7; ++i) {
    for (int j = 0; j <= 5; ++j) {
      const Vec3 p = Position(shape, i / 7.0, j / 5.0);
      EXPECT_NEAR(p.x(), -10 + 60 * i / 7.0, 1e-12);
      EXPECT_NEAR(p.y(), 20 + 20 * j / 5.0, 1e-12);
      EXPECT_NEAR(p.z(), BumpyHeight(p.x(), p.y()), 1e-11);
    }
  }
}

TEST(InterpolatedHeights, ReproducesCubics) {  // which only the right end conditions do
  const auto cubic = [](double x, double y) { return (1 + x - 2 * x * x * x) * (3 - y * y + y * y * y); };
  const PatchShape shape = InterpolatedHeights(cubic, -1, 1, 0, 2, 4, 3);
  Random random(5);
  for (int k = 0; k < 200; ++k) {
    const Vec3 p = Position(shape, random.Unit(), random.Unit());
    EXPECT_NEAR(p.z(), cubic(p.x(), p.y()), 1e-12);
  }
}

TEST(InterpolatedHeights, ReferencePartsAreCloseToTheirFunctions) {
  Random random(6);
  const PatchModel hills = TwoHills(), bumpy = Bumpy();
  EXPECT_EQ(SplitIntoPieces(PatchId(0), hills.patches[0].shape).size(), 1024u);
  EXPECT_EQ(SplitIntoPieces(PatchId(0), bumpy.patches[0].shape).size(), 2500u);
  for (int k = 0; k < 1000; ++k) {
    const double u = random.Unit(), v = random.Unit();
    const Vec3 p = Position(hills.patches[0].shape, u, v), q = Position(bumpy.patches[0].shape, u, v);
    EXPECT_NEAR(p.z(), TwoHillsHeight(p.x(), p.y()), 0.01);
    EXPECT_NEAR(q.z(), BumpyHeight(q.x(), q.y()), 0.2);
  }
}

TEST(Block, StandsOnItsFloor) {
  const PatchModel block = Block(4, 7, 12);
  ASSERT_EQ(block.patches.size(), 13u);
  double area = 0;
  for (const Patch& patch : block.patches) {
    const SurfaceJet jet = Evaluate(patch.shape, 0.5, 0.5);
    const Vec3 normal = jet.du.cross(jet.dv);
    area += normal.norm();
    // Outward: up on floor and top, away from the axis on the walls.
    EXPECT_GT(normal.dot(Vec3(jet.p.x(), jet.p.y(), normal.z())), 0.0);
  }
  EXPECT_NEAR(area, 24 * 24 + 4 * 8 * 7, 1e-12);
}

TEST(RandomBspline, IsReproducibleAndFoldsOnDemand) {
  const auto folded = [](const PatchModel& model) {
    int under = 0;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 40; ++j) {
        const SurfaceJet jet = Evaluate(model.patches[0].shape, i / 40.0, j / 40.0);
        if (jet.du.cross(jet.dv).z() < 0) ++under;
      }
    }
    return under;
  };
  EXPECT_EQ(folded(RandomBspline(3)), 0);
  EXPECT_GT(folded(RandomBspline(3, {.folds = true})), 50);
  EXPECT_EQ(Position(RandomBspline(9).patches[0].shape, 0.3, 0.4),
            Position(RandomBspline(9).patches[0].shape, 0.3, 0.4));
  EXPECT_NE(Position(RandomBspline(9).patches[0].shape, 0.3, 0.4),
            Position(RandomBspline(8).patches[0].shape, 0.3, 0.4));
}

}  // namespace
}  // namespace patchmill::testing
