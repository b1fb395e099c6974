#include "core/base/round_outward.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

TEST(RoundUp, IsTheNextFloat) {
  testing::Random random(2);
  std::vector<double> numbers{
      0.0,       -0.0,       1e-46, -1e-46, 1.4e-45, -1.4e-45, 1e39, -1e39, 3.4028234663852886e38,
      kInfinity, -kInfinity, 1.0,   -1.0};
  for (int k = 0; k < 10'000; ++k)
    numbers.push_back(random.Uniform(-1.0, 1.0) * std::pow(10.0, random.Uniform(-46.0, 38.0)));
  for (const double x : numbers) {
    const auto f = static_cast<float>(x);
    EXPECT_EQ(RoundUp(x), std::nextafterf(f, HUGE_VALF)) << x;
    EXPECT_EQ(RoundDown(x), std::nextafterf(f, -HUGE_VALF)) << x;
  }
  EXPECT_TRUE(std::isnan(RoundUp(std::nan(""))));
}

}  // namespace
}  // namespace patchmill
