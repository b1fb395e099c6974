#include "core/math/box_qp.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

TEST(BoxQp, NoPointOfTheBoxIsLower) {
  testing::Random random(1);
  for (int i = 0; i < 20000; ++i) {
    Quadratic2 f{random.Uniform(-2, 4), random.Uniform(-2, 2), random.Uniform(-2, 4), random.Uniform(-3, 3),
                 random.Uniform(-3, 3)};
    if (i % 7 == 0) f.a = f.b = 0.0;  // singular
    if (i % 11 == 0) f.c = f.b = 0.0;
    const Box2 box{random.Uniform(-2, 0), random.Uniform(0, 2), random.Uniform(-2, 0), random.Uniform(0, 2)};
    const BoxMinimum got = MinimizeOnBox(f, box);
    ASSERT_TRUE(got.x >= box.x0 && got.x <= box.x1 && got.y >= box.y0 && got.y <= box.y1);
    ASSERT_NEAR(got.value, f(got.x, got.y), 1e-12);
    for (int k = 0; k < 30; ++k) {
      const double x = random.Uniform(box.x0, box.x1), y = random.Uniform(box.y0, box.y1);
      ASSERT_GE(f(x, y), got.value - 1e-12);
    }
    for (const double x : {box.x0, box.x1}) {
      for (const double y : {box.y0, box.y1}) ASSERT_GE(f(x, y), got.value - 1e-12);
    }
  }
}

TEST(BoxQp, InsideAndOnEveryEdge) {
  const Box2 box{-1, 1, -1, 1};
  const Quadratic2 bowl{2, 0, 2, 0, 0};
  EXPECT_EQ(MinimizeOnBox(bowl, box).value, 0.0);
  // Coupled: clamping the free minimum (4,-3) component-wise gives (1,-1); the minimum is elsewhere.
  const Quadratic2 f{1.0, 0.9, 1.0, -1.3, -0.6};
  const BoxMinimum m = MinimizeOnBox(f, box);
  EXPECT_NEAR(m.x, 1.0, 1e-15);
  EXPECT_NEAR(m.y, -0.3, 1e-15);
}

}  // namespace
}  // namespace patchmill
