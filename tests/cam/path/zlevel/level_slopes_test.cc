// Bounds on the slopes of a net against its true normals.
#include "cam/path/zlevel/level_slopes.h"

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "core/patch/piece.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

// Every normal of every part lies in the part's range.
void CheckNet(const Piece& piece) {
  for (const double size : {1.0, 0.5, 0.125, 0.03125}) {
    for (double u0 = 0.0; u0 + size <= 1.0; u0 += std::max(size, 0.25)) {
      for (double v0 = 0.0; v0 + size <= 1.0; v0 += std::max(size, 0.25)) {
        const SlopeRange range = BoundSlopes(SubNet(piece.net, u0, u0 + size, v0, v0 + size));
        for (int k = 0; k < 36; ++k) {
          const auto normal =
              UpwardNormal(Evaluate(piece, u0 + size * (k / 6 / 5.0), v0 + size * (k % 6 / 5.0)));
          if (!normal) continue;
          const double slope = std::atan2(std::hypot(normal->x(), normal->y()), normal->z());
          EXPECT_GE(slope, range.min - 1e-9);
          EXPECT_LE(slope, range.max + 1e-9);
        }
      }
    }
  }
}

TEST(ContourSlopes, PlanesHaveOneSlope) {
  const PatchModel plane = testing::Plane(10.0, 0.0, 0.75, 0.0);
  const SlopeRange range = BoundSlopes(SplitIntoPieces(PatchId(0), plane.patches[0].shape)[0].net);
  EXPECT_NEAR(range.min, std::atan(0.75), 1e-6);
  EXPECT_NEAR(range.max, std::atan(0.75), 1e-6);
}

TEST(ContourSlopes, HoldAllNormalsOfRandomPatches) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    for (const bool rational : {false, true}) {
      const PatchShape shape = testing::RandomBezier(seed, 3, 4, rational);
      CheckNet(SplitIntoPieces(PatchId(0), shape)[0]);
    }
    for (const auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
      const PatchShape shape = testing::RandomGregory(seed, blend);
      CheckNet(SplitIntoPieces(PatchId(0), shape)[0]);
    }
  }
}

TEST(ContourSlopes, SmallPartsHaveNarrowRanges) {
  const PatchModel sphere = testing::Sphere(Vec3::Zero(), 10.0);
  const Piece piece = SplitIntoPieces(PatchId(0), sphere.patches[0].shape)[0];
  const SlopeRange range = BoundSlopes(SubNet(piece.net, 0.5, 0.53125, 0.5, 0.53125));
  EXPECT_LT(range.max - range.min, 0.3);
}

TEST(ContourSlopes, DegenerateNetsPromiseNothing) {
  const PatchShape line = testing::Bilinear({0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0});
  const SlopeRange range = BoundSlopes(SplitIntoPieces(PatchId(0), line)[0].net);
  EXPECT_EQ(range.min, 0.0);
  EXPECT_EQ(range.max, kPi / 2.0);
}

}  // namespace
}  // namespace patchmill
