// Border points of one level by themselves; contours as wholes are in level_trace_closed_forms_test.cc.
#include "cam/path/zlevel/level_oracle.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/run_context.h"
#include "tests/support/joined_surface.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// A dome far from the origin, where rounding is 1e-13 mm: at this level the ball's centre stays 12 mm off
// its axis.
class FarDome : public ::testing::Test {
 protected:
  FarDome()
      : surface_(JoinedSurface(Sphere(kMiddle, 10.0, Half::kUpper))),
        locator_(*Locator::Make(surface_, 3.0, RunContext())),
        sides_(surface_, RunContext()),
        oracle_(locator_, sides_, kMiddle.z() + 5.0) {}

  static inline const Vec3 kMiddle{1000.0, 700.0, 0.0};
  Surface surface_;
  Locator locator_;
  PieceSides sides_;
  LevelOracle oracle_;
};

// However short the stretch: its end is no border point where the border lies beyond it.
TEST_F(FarDome, NoRootBeforeTheBorder) {
  Random random(7);
  for (int i = 0; i < 500; ++i) {
    const double angle = random.Uniform(0.0, 2.0 * kPi), reach = std::pow(10.0, random.Uniform(-4.0, 0.0));
    const Vec2 out(std::cos(angle), std::sin(angle));
    const Vec2 m = Xy(kMiddle) + random.Uniform(9.5, 10.5) * out;
    const std::optional<SurfacePoint> contact = oracle_.Obstacle(m, nullptr);
    ASSERT_TRUE(contact);
    EXPECT_FALSE(oracle_.RootOnLine(m, out, *contact, *contact, {0.0, reach, true})) << reach;
  }
}

TEST_F(FarDome, TheRootWhereItIs) {
  Random random(8);
  for (int i = 0; i < 500; ++i) {
    const double angle = random.Uniform(0.0, 2.0 * kPi);
    const Vec2 out(std::cos(angle), std::sin(angle));
    const Vec2 m = Xy(kMiddle) + random.Uniform(11.0, 11.9) * out;
    const std::optional<SurfacePoint> contact = oracle_.Obstacle(m, nullptr);
    ASSERT_TRUE(contact);
    const auto root = oracle_.RootOnLine(m, out, *contact, *contact, {0.0, 2.0, true});
    ASSERT_TRUE(root);
    EXPECT_NEAR((root->q - Xy(kMiddle)).norm(), 12.0, 1e-8);
  }
}

}  // namespace
}  // namespace patchmill
