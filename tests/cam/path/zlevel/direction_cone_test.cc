#include "cam/path/zlevel/direction_cone.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

Vec2 Along(double angle, double length = 1.0) { return length * Vec2(std::cos(angle), std::sin(angle)); }

// The arc that holds all directions and is narrower than half a turn, by the widest gap between neighbours:
// its width, none where there is no such arc.
std::optional<double> ArcOf(std::vector<double> angles) {
  for (double& a : angles) a -= 2.0 * kPi * std::floor(a / (2.0 * kPi));
  std::sort(angles.begin(), angles.end());
  double widest = angles.front() + 2.0 * kPi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
  const double arc = 2.0 * kPi - widest;
  if (arc < kPi) return arc;
  return std::nullopt;
}

void ExpectCone(const DirectionCone& cone, const std::vector<double>& angles) {
  const std::optional<double> arc = ArcOf(angles);
  ASSERT_EQ(cone.valid, arc.has_value());
  if (!arc) return;
  EXPECT_FALSE(cone.empty);
  EXPECT_NEAR(cone.Angle(), *arc, 1e-12);
  for (const double a : angles) {
    EXPECT_GE(Cross(cone.right, Along(a)), -1e-12);
    EXPECT_LE(Cross(cone.left, Along(a)), 1e-12);
  }
}

DirectionCone Nothing() {
  DirectionCone cone;
  cone.valid = true;
  return cone;
}

TEST(DirectionCone, HoldsDirectionsInAnyOrder) {
  testing::Random random(17);
  int valid = 0;
  for (int round = 0; round < 20000; ++round) {
    const double middle = 2.0 * kPi * random.Unit(), spread = 2.0 * kPi * random.Unit();
    std::vector<double> angles(2 + round % 5);
    DirectionCone cone = Nothing();
    for (double& a : angles) {
      a = middle + spread * (random.Unit() - 0.5);
      cone.Add(Along(a, 0.1 + 10.0 * random.Unit()));
    }
    ExpectCone(cone, angles);
    valid += cone.valid;
  }
  EXPECT_GT(valid, 5000);
  EXPECT_LT(valid, 19000);
}

TEST(DirectionCone, HoldsOtherCones) {
  testing::Random random(18);
  int valid = 0;
  for (int round = 0; round < 20000; ++round) {
    DirectionCone both = Nothing();
    std::vector<double> ends;
    for (int k = 0; k < 2; ++k) {
      const double right = 2.0 * kPi * random.Unit(), left = right + 0.999 * kPi * random.Unit();
      DirectionCone one = Nothing();
      one.Add(Along(right));
      one.Add(Along(left));
      both.Add(one);
      both.Add(Nothing());  // adds nothing
      ends.insert(ends.end(), {right, left});
    }
    ExpectCone(both, ends);
    valid += both.valid;
  }
  EXPECT_GT(valid, 2000);
  EXPECT_LT(valid, 19000);
  DirectionCone cone = Nothing();
  cone.Add(Along(1.0));
  cone.Add(DirectionCone());  // every direction
  EXPECT_FALSE(cone.valid);
}

}  // namespace
}  // namespace patchmill
