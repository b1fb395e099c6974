// Follow: a smooth branch goes on over the borders of patches, seams and poles; a branch that ends, ends.
#include <cmath>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;
using testing::SurfaceOf;

TEST(Follow, SphereAndTorusAcrossTheirPatches) {
  // One smooth branch everywhere: following any small move gives h.
  struct Case {
    PatchModel model;
    double lo, hi;  // distance from the axis
  };
  for (const Case& c : {Case{testing::Sphere(Vec3(0, 0, 0), 10.0), 0.0, 12.5},
                        Case{testing::Torus(Vec3(0, 0, 0), 20.0, 6.0), 11.6, 28.4}}) {
    const Surface surface = SurfaceOf(c.model);
    const Locator locator(surface, 3.0);
    Random random(3);
    for (int i = 0; i < 3000; ++i) {
      const double d = random.Uniform(c.lo, c.hi), phi = random.Uniform(0, 2 * kPi);
      const Vec2 q0(d * std::cos(phi), d * std::sin(phi));
      const double step = random.Uniform(0.0, 0.4), psi = random.Uniform(0, 2 * kPi);
      const Vec2 q1 = q0 + step * Vec2(std::cos(psi), std::sin(psi));
      const auto h0 = locator.Height(q0), h1 = locator.Height(q1);
      ASSERT_TRUE(h0 && h1);
      const auto followed = locator.Follow(h0->contact, q1);
      ASSERT_TRUE(followed.has_value()) << q0.transpose() << " -> " << q1.transpose();
      EXPECT_NEAR(followed->z, h1->z, 1e-9) << q0.transpose() << " -> " << q1.transpose();
    }
  }
}

TEST(Follow, StaysOnItsSideOfAValley) {
  const double angle = Radians(30.0), r = 3.0;
  const Surface surface = SurfaceOf(testing::TwoPlanes(angle, 20.0));
  const Locator locator(surface, r);
  const auto left = locator.Height({-1.0, 0.0});
  ASSERT_TRUE(left.has_value());
  // Beyond x = 0 the left plane's branch goes on, below h.
  const auto followed = locator.Follow(left->contact, {0.5, 0.0});
  ASSERT_TRUE(followed.has_value());
  EXPECT_NEAR(followed->z, -0.5 * std::tan(angle) + r / std::cos(angle), 1e-9);
  EXPECT_LT(followed->contact.p.x(), 0.0);
}

TEST(Follow, RollsOverARidgeToTheOtherSide) {
  const double angle = Radians(40.0), r = 3.0;
  const Surface surface = SurfaceOf(testing::TwoPlanes(-angle, 30.0));
  const Locator locator(surface, r);
  const auto on_ridge = locator.Height({0.5, 0.0});
  ASSERT_TRUE(on_ridge.has_value());
  for (const double x : {-5.0, 5.0}) {
    const auto followed = locator.Follow(on_ridge->contact, {x, 0.3});
    ASSERT_TRUE(followed.has_value());
    EXPECT_NEAR(followed->z, -std::abs(x) * std::tan(angle) + r / std::cos(angle), 1e-9);
  }
}

TEST(Follow, EndsWhereTheContactLeavesTheDisc) {
  const Surface surface = SurfaceOf(testing::Block(10.0, 8.0, 40.0));
  const Locator locator(surface, 3.0);
  const auto on_rim = locator.Height({12.0, 0.0});
  ASSERT_TRUE(on_rim.has_value());
  EXPECT_TRUE(locator.Follow(on_rim->contact, {12.9, 0.0}).has_value());
  const auto beyond = locator.Follow(on_rim->contact, {13.2, 0.0});
  // Beyond the wall the rim is out of reach; down the wall the same. The floor is another branch.
  EXPECT_TRUE(!beyond || beyond->z <= 3.0 + 1e-9);
  EXPECT_FALSE(locator.Follow(on_rim->contact, {100.0, 0.0}).has_value());
}

TEST(Follow, AgreesWithHeightOnSmoothFineSplitSurface) {
  // Gentle hills (no switch): every border between the 1024 patches is crossed silently.
  const Surface surface = SurfaceOf(testing::TwoHills());
  const Locator locator(surface, 3.0);
  Random random(5);
  int crossings = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec2 q0(random.Uniform(5, 95), random.Uniform(5, 95));
    const double phi = random.Uniform(0, 2 * kPi);
    const Vec2 q1 = q0 + random.Uniform(0.0, 0.5) * Vec2(std::cos(phi), std::sin(phi));
    const auto h0 = locator.Height(q0), h1 = locator.Height(q1, &h0->contact);
    const auto followed = locator.Follow(h0->contact, q1);
    ASSERT_TRUE(followed.has_value());
    EXPECT_NEAR(followed->z, h1->z, 1e-9) << q0.transpose() << " -> " << q1.transpose();
    crossings += h0->contact.piece != h1->contact.piece;
  }
  EXPECT_GT(crossings, 100);
}

}  // namespace
}  // namespace patchmill
