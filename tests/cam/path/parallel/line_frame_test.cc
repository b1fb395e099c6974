#include "cam/path/parallel/line_frame.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

// Along and Across are unit, square to each other, and At moves by Stretch along and by one across.
void ExpectFrame(const LineFrame& frame, double t, double y) {
  constexpr double kStep = 1e-6;
  const Vec2 dt = (frame.At(t + kStep, y) - frame.At(t - kStep, y)) / (2.0 * kStep);
  const Vec2 dy = (frame.At(t, y + kStep) - frame.At(t, y - kStep)) / (2.0 * kStep);
  EXPECT_NEAR((dt - frame.Stretch(y) * frame.Along(t)).norm(), 0.0, 1e-8);
  EXPECT_NEAR((dy - frame.Across(t)).norm(), 0.0, 1e-8);
  EXPECT_NEAR(frame.Along(t).norm(), 1.0, 1e-14);
  EXPECT_NEAR(frame.Along(t).dot(frame.Across(t)), 0.0, 1e-14);
}

TEST(LineFrame, StraightIsATurnedGrid) {
  const LineFrame frame = LineFrame::At(Radians(30));
  EXPECT_FALSE(frame.round());
  EXPECT_EQ(frame.period(), kInfinity);
  EXPECT_NEAR((frame.At(2.0, 4.0) - Vec2(std::sqrt(3.0) - 2.0, 1.0 + 2.0 * std::sqrt(3.0))).norm(), 0.0,
              1e-14);
  for (const double t : {-7.0, 0.0, 3.0}) ExpectFrame(frame, t, 2.5);
}

TEST(LineFrame, RoundHasTheDistanceAcrossAndRepeats) {
  const Vec2 center(3, -2);
  const LineFrame frame = LineFrame::Around(center, 12.0);
  EXPECT_TRUE(frame.round());
  EXPECT_NEAR(frame.period(), 24.0 * kPi, 1e-12);
  EXPECT_NEAR((frame.At(0.0, 5.0) - Vec2(8, -2)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((frame.At(6.0 * kPi, 5.0) - Vec2(3, 3)).norm(), 0.0, 1e-14);  // a quarter, counter-clockwise
  for (const double t : {-7.0, 0.0, 3.0, 40.0}) {
    for (const double y : {0.5, 5.0, 12.0}) {
      ExpectFrame(frame, t, y);
      EXPECT_NEAR((frame.At(t, y) - center).norm(), y, 1e-13);
      EXPECT_NEAR((frame.At(t, y) - frame.At(t + frame.period(), y)).norm(), 0.0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace patchmill
