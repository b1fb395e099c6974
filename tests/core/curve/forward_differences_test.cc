// Forward differences: the vector of [curves, section 7], exactness, the stated error.
#include "core/curve/forward_differences.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/json.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Json;
using testing::Random;

TEST(CubicStepper, Vector) {
  const Json d = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/hosaka_dda.json");
  const auto integer = [](const Json& j) { return static_cast<std::int64_t>(j.Number()); };
  const int n = static_cast<int>(integer(d["n"]));
  auto stepper = CubicStepper::Make(n, integer(d["a"]), integer(d["b"]), integer(d["c"]));
  ASSERT_TRUE(stepper.ok());
  EXPECT_EQ(stepper->first(), integer(d["A0"]));
  EXPECT_EQ(stepper->second(), integer(d["B0"]));
  EXPECT_EQ(stepper->third(), integer(d["C0"]));
  for (int i = 0; i <= 1 << n; ++i) {
    EXPECT_EQ(stepper->value(), integer(d["R"][i]));
    const std::int64_t before = stepper->whole();
    stepper->Step();
    if (i < 1 << n) {
      EXPECT_EQ(stepper->whole() - before, integer(d["pulses"][i]));
    }
  }
}

TEST(CubicStepper, IsExactForEveryStep) {
  Random random(1);
  for (int k = 0; k < 200; ++k) {
    const int n = random.Int(11);
    const auto draw = [&] { return static_cast<std::int64_t>(random.Int(2000001)) - 1000000; };
    const std::int64_t a = draw(), b = draw(), c = draw();
    auto stepper = CubicStepper::Make(n, a, b, c);
    ASSERT_TRUE(stepper.ok());
    const std::int64_t one = std::int64_t{1} << n;
    for (std::int64_t i = 0; i <= one; ++i) {
      ASSERT_EQ(stepper->value(), a * i * one * one + b * i * i * one + c * i * i * i);
      stepper->Step();
    }
  }
}

TEST(CubicStepper, RefusesWhatDoesNotFit) {
  EXPECT_FALSE(CubicStepper::Make(17, 1, 1, 1).ok());
  EXPECT_FALSE(CubicStepper::Make(-1, 1, 1, 1).ok());
  EXPECT_FALSE(CubicStepper::Make(16, 4096, 0, 0).ok());
  EXPECT_TRUE(CubicStepper::Make(16, 511, 0, 0).ok());
}

TEST(ForwardDifferences, StayWithinTheStatedError) {
  Random random(2);
  for (int k = 0; k < 50; ++k) {
    const HermiteCurve c{random.Point(-50, 50), random.Point(-50, 50), random.Point(-50, 50),
                         random.Point(-50, 50)};
    const double unit = 0.001;
    const auto points = ForwardDifferences(c, 6, unit);
    ASSERT_TRUE(points.ok()) << points.status();
    ASSERT_EQ(points->size(), 65u);
    for (int i = 0; i <= 64; ++i) {
      const Vec3 exact = (Evaluate(c, i / 64.0).p - c.p0) / unit;
      for (int axis = 0; axis < 3; ++axis) {
        const auto got =
            static_cast<double>((*points)[static_cast<std::size_t>(i)][static_cast<std::size_t>(axis)]);
        EXPECT_LE(std::abs(got - exact[axis]), kForwardDifferenceError);
      }
    }
  }
  EXPECT_FALSE(ForwardDifferences({}, 4, 0.0).ok());
  EXPECT_FALSE(
      ForwardDifferences({Vec3::Zero(), Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0)}, 10, 1e-14).ok());
}

}  // namespace
}  // namespace patchmill
