// In which directions a border runs.
#include "cam/plan/main_directions.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

std::vector<Vec2> Rectangle(double angle, double length, double width) {
  const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
  return {length * along, width * across, -length * along, -width * across};
}

TEST(MainDirections, OfARectangleAreItsSides) {
  for (double angle = 0.0; angle < 180.0; angle += 0.7) {
    const auto found = MainDirections(Rectangle(Radians(angle), 5.0, 2.0), 4);
    ASSERT_EQ(found.size(), 2u) << angle;
    EXPECT_LT(DirectionsApart(found[0], AsDirection(Radians(angle))), 1e-9) << angle;
    EXPECT_LT(DirectionsApart(found[1], AsDirection(Radians(angle + 90.0))), 1e-9) << angle;
    EXPECT_EQ(MainDirections(Rectangle(Radians(angle), 5.0, 2.0), 1).size(), 1u);
  }
}

TEST(MainDirections, OfACircleAreNone) {
  std::vector<Vec2> steps;
  for (int k = 0; k < 500; ++k) steps.emplace_back(std::cos(k * kPi / 250.0), std::sin(k * kPi / 250.0));
  EXPECT_TRUE(MainDirections(steps, 2).empty());
  EXPECT_TRUE(MainDirections({}, 2).empty());
}

TEST(MainDirections, AreTheMeanOfASideThatIsNotQuiteStraight) {
  std::vector<Vec2> steps;
  for (const double off : {-1.0, 1.0, 0.5, -0.5}) {
    const double angle = Radians(179.5 + off);  // about where directions begin again
    steps.emplace_back(std::cos(angle), std::sin(angle));
  }
  const auto found = MainDirections(steps, 2);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT(DirectionsApart(found[0], Radians(179.5)), 1e-9);
}

TEST(MainDirections, DoNotDependOnWhichWayAStepGoes) {
  // A way there and back along a wall, with a stretch across.
  std::vector<Vec2> steps;
  for (int k = 0; k < 12; ++k)
    steps.push_back((k % 3 == 0 ? -1.0 : 1.0) * Vec2(std::cos(0.3), std::sin(0.3)));
  for (int k = 0; k < 5; ++k) steps.push_back((k % 2 == 0 ? -1.0 : 1.0) * Vec2(std::cos(1.4), std::sin(1.4)));
  const auto found = MainDirections(steps, 2);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0], 0.3, 1e-12);
  EXPECT_NEAR(found[1], 1.4, 1e-12);
}

}  // namespace
}  // namespace patchmill
