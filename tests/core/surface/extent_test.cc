#include "core/surface/extent.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Half;

Surface Build(const PatchModel& model) {
  PatchNetwork network;
  network.model = model;
  auto surface = BuildSurface(std::move(network), SurfaceParams{}, RunContext{});
  EXPECT_TRUE(surface.ok()) << surface.status();
  return *std::move(surface);
}

TEST(TightBox, IsExactOnClosedForms) {
  const Box3 torus = TightBox(Build(testing::Torus(Vec3(1, 2, 3), 20, 6)));
  EXPECT_LT((torus.min - Vec3(1 - 26, 2 - 26, 3 - 6)).norm(), 1e-6);
  EXPECT_LT((torus.max - Vec3(1 + 26, 2 + 26, 3 + 6)).norm(), 1e-6);
  const Box3 block = TightBox(Build(testing::Block(5, 7, 20)));
  EXPECT_LT((block.min - Vec3(-20, -20, 0)).norm(), 1e-12);
  EXPECT_LT((block.max - Vec3(20, 20, 7)).norm(), 1e-12);
}

TEST(LowestPoint, LiesOnTheSurfaceAndNothingIsLower) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const Surface surface = Build(testing::RandomBspline(seed));
    const SurfacePoint low = LowestPoint(surface), high = HighestPoint(surface);
    EXPECT_EQ(low.p, Position(surface.piece(low.piece), low.u, low.v));
    for (const Piece& piece : surface.pieces) {
      for (int i = 0; i <= 20; ++i) {
        for (int j = 0; j <= 20; ++j) {
          const double z = Position(piece, i / 20.0, j / 20.0).z();
          EXPECT_GE(z, low.p.z() - 1e-7);
          EXPECT_LE(z, high.p.z() + 1e-7);
        }
      }
    }
  }
}

}  // namespace
}  // namespace patchmill
