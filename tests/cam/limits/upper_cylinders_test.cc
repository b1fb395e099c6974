#include "cam/limits/upper_cylinders.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "cam/tool/tool.h"

namespace patchmill {
namespace {

Tool Ball(double radius) {
  Tool tool;
  tool.cutter = BallEnd{radius};
  return tool;
}

TEST(UpperCylinders, NoneAboveASlimTool) {
  Tool tool = Ball(3.0);
  EXPECT_TRUE(UpperCylindersOf(tool).empty());
  tool.flute_length = 10.0;
  tool.shank_diameter = 6.0;
  EXPECT_TRUE(UpperCylindersOf(tool).empty());
  tool.holder = {{20.0, 30.0, 30.0}};
  EXPECT_TRUE(UpperCylindersOf(tool).empty());  // nothing says where it begins
  tool.stickout = 25.0;
  tool.holder = {{20.0, 3.0, 4.0}};
  tool.holder_clearance = 0.5;
  EXPECT_TRUE(UpperCylindersOf(tool).empty());  // slimmer than the ball
}

TEST(UpperCylinders, ShankThenHolder) {
  Tool tool = Ball(3.0);
  tool.flute_length = 10.0;
  tool.shank_diameter = 8.0;
  tool.stickout = 25.0;
  // The second segment is hidden above the first.
  tool.holder = {{20.0, 30.0, 30.0}, {5.0, 28.0, 20.0}, {10.0, 40.0, 40.0}};
  tool.holder_clearance = 0.25;
  const auto cylinders = UpperCylindersOf(tool);
  ASSERT_EQ(cylinders.size(), 3u);
  EXPECT_EQ(cylinders[0].part, UpperPart::kShank);
  EXPECT_EQ(cylinders[0].radius, 4.0);
  EXPECT_EQ(cylinders[0].rise, 7.0);
  EXPECT_EQ(cylinders[1].part, UpperPart::kHolder);
  EXPECT_EQ(cylinders[1].radius, 15.25);
  EXPECT_EQ(cylinders[1].rise, 25.0 - 3.0 - 0.25);
  EXPECT_EQ(cylinders[2].radius, 20.25);
  EXPECT_EQ(cylinders[2].rise, 25.0 + 25.0 - 3.0 - 0.25);
}

// The stairs contain the cone and exceed it by no more than a step.
TEST(UpperCylinders, StairsAroundACone) {
  Tool tool = Ball(2.0);
  tool.stickout = 20.0;
  tool.holder = {{30.0, 10.0, 24.0}};
  tool.holder_clearance = 0.0;
  const auto cylinders = UpperCylindersOf(tool);
  ASSERT_EQ(cylinders.size(), 28u);
  for (int k = 0; k <= 1000; ++k) {
    const double height = 0.03 * k, cone = 5.0 + 7.0 * height / 30.0;
    double stairs = 0.0;
    for (const UpperCylinder& c : cylinders)
      if (c.rise <= 18.0 + height + 1e-12) stairs = std::max(stairs, c.radius);
    EXPECT_GE(stairs, cone - 1e-12);
    EXPECT_LE(stairs, cone + kHolderStep + 1e-12);
  }
  // A cone that becomes slimmer upwards is a cylinder in its upward sweep.
  tool.holder = {{30.0, 24.0, 10.0}};
  ASSERT_EQ(UpperCylindersOf(tool).size(), 1u);
  EXPECT_EQ(UpperCylindersOf(tool).front().radius, 12.0);
  // A steep and wide one has a bounded number of steps.
  tool.holder = {{30.0, 10.0, 500.0}};
  EXPECT_EQ(UpperCylindersOf(tool).size(), static_cast<std::size_t>(kMostHolderSteps));
  EXPECT_EQ(UpperCylindersOf(tool).back().radius, 250.0);
}

}  // namespace
}  // namespace patchmill
