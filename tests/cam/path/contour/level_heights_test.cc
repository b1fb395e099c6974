// Heights of full levels: their number and the needs that decide, against the cost of other heights.
#include "cam/path/contour/level_heights.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/stepover/step_over.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr HeightParams kParams = {.radius = 3.0, .flat = 0.5, .smallest = 0.125};
constexpr double kSpacing = 0.5;

// A wall of the plane y = const: samples over [x0, x1] x [z0, z1] that all need this step.
void AddWall(double x0, double x1, double z0, double z1, double step, double y, ContourArea& contour_area) {
  const auto count = [](double length) { return static_cast<int>(std::ceil(length / kSpacing)); };
  const int nx = count(x1 - x0), nz = count(z1 - z0);
  for (int i = 0; i < nx; ++i) {
    for (int k = 0; k < nz; ++k) {
      const double half = 0.5 * (z1 - z0) / nz;
      contour_area.samples.push_back(
          {{x0 + (i + 0.5) * (x1 - x0) / nx, y, z0 + (2 * k + 1) * half}, half, half, step, (x1 - x0) / nx});
    }
  }
  contour_area.spacing = kSpacing;
}

std::vector<double> HeightsOf(const ContourArea& contour_area) {
  const auto heights = LevelHeights(contour_area, kParams, RunContext(2));
  EXPECT_TRUE(heights.ok()) << heights.status();
  return heights->heights;
}

double WidestGap(const std::vector<double>& heights) {
  double widest = 0.0;
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) widest = std::max(widest, heights[i + 1] - heights[i]);
  return widest;
}

TEST(LevelHeights, OfOneNeedAreThatFarApartAndHalfOfItFromTheEnds) {
  for (const double height : {1.3, 5.0, 12.4, 12.6}) {
    ContourArea contour_area;
    AddWall(0.0, 40.0, 0.0, height, 0.5, 0.0, contour_area);
    const std::vector<double> heights = HeightsOf(contour_area);
    ASSERT_FALSE(heights.empty());
    const double to = (std::floor(height / 0.0625 + 1e-9) + 1.0) * 0.0625;  // the samples are in eighths
    // The smallest number of levels whose gaps are too wide by no more than what a partial pass is added for.
    const double count = std::ceil(to / (0.5 * kParams.wide) - 1e-9);
    ASSERT_EQ(static_cast<double>(heights.size()), count) << height;
    for (std::size_t i = 0; i < heights.size(); ++i)
      EXPECT_NEAR(heights[i], (static_cast<double>(i) + 0.5) * to / count, 1e-6) << height;
  }
}

// Where the tolerance bears no more than the scallop, and a level more is less than a tenth, gaps are not
// wider than their need.
TEST(LevelHeights, AreNotTooWideThroughout) {
  for (const double height : {9.55, 15.0, 20.02}) {
    ContourArea contour_area;
    AddWall(0.0, 40.0, 0.0, height, 0.5, 0.0, contour_area);
    HeightParams exact = kParams;
    exact.wide = 1.001;
    const auto heights = LevelHeights(contour_area, exact, RunContext(1));
    ASSERT_TRUE(heights.ok());
    EXPECT_LE(WidestGap(heights->heights), 1.001 * 0.5) << height;
  }
}

TEST(LevelHeights, LieAtCommonLowerEnds) {
  ContourArea contour_area;
  AddWall(0.0, 40.0, 0.0, 6.05, 0.5, 0.0, contour_area);
  contour_area.lower_ends.push_back({Vec3(0, 0, 0), 40.0});
  contour_area.lower_ends.push_back({Vec3(0, 0, 3), 40.0});
  const std::vector<double> heights = HeightsOf(contour_area);
  for (const double end : {0.0, 3.0}) {
    EXPECT_TRUE(std::any_of(heights.begin(), heights.end(), [&](double z) {
      return z >= end && z <= end + 1e-5;
    })) << end;
  }
  EXPECT_LE(WidestGap(heights), kParams.wide * 0.5 + 1e-9);
}

// A part of a wall needs a smaller step. It gets full levels for the whole wall, or partial levels, whichever
// is shorter.
TEST(LevelHeights, FollowTheNarrowSurfaceWhereThatIsShorter) {
  const double wide = 0.5, narrow = 0.4, height = 20.0, length = 200.0;
  for (const double share : {0.05, 0.4, 0.6}) {
    ContourArea contour_area;
    AddWall(0.0, length * (1.0 - share), 0.0, height, wide, 0.0, contour_area);
    AddWall(length * (1.0 - share), length, 0.0, height, narrow, 0.0, contour_area);
    const std::vector<double> heights = HeightsOf(contour_area);
    const double all = length / narrow, both = length * (1.0 + share) / wide;  // a mm of height
    const double best = both < all ? wide : narrow;
    EXPECT_NEAR(height / static_cast<double>(heights.size()), best, 0.03 * best) << share;
  }
}

// Only the surface at one height needs a small step.
TEST(LevelHeights, AreNearerOnlyWhereTheSurfaceAsksForIt) {
  ContourArea contour_area;
  AddWall(0.0, 50.0, 0.0, 10.0, 0.5, 0.0, contour_area);
  AddWall(0.0, 50.0, 10.0, 14.0, 0.25, 0.0, contour_area);
  const std::vector<double> heights = HeightsOf(contour_area);
  int low = 0, high = 0;
  for (const double z : heights) ++(z < 9.8 ? low : high);
  EXPECT_NEAR(low, 9.8 / 0.5, 2.0);
  EXPECT_NEAR(high, 4.2 / 0.25, 2.0);
}

TEST(LevelHeights, DoNotDependOnTheOrderOfSamples) {
  ContourArea contour_area;
  Random random(5);
  for (int k = 0; k < 40; ++k) {
    const double z = random.Uniform(0.0, 12.0);
    AddWall(0.0, 10.0, z, z + random.Uniform(1.0, 6.0), random.Uniform(0.2, 0.6), 3.0 * k, contour_area);
  }
  const std::vector<double> heights = HeightsOf(contour_area);
  ContourArea other = contour_area;
  std::reverse(other.samples.begin(), other.samples.end());
  const std::vector<double> again = HeightsOf(other);
  ASSERT_EQ(heights.size(), again.size());
  for (std::size_t i = 0; i < heights.size(); ++i) EXPECT_NEAR(heights[i], again[i], 1e-9);
}

// Rounded tops allow steps of three times that on a plane; what stands beside them does not.
TEST(LevelHeights, AreNeverSoFarApartThatTheyWouldTakeTheSurfaceForNone) {
  for (const double share : {0.0, 0.02, 0.1, 0.3}) {
    ContourArea contour_area;
    AddWall(0.0, 100.0 * (1.0 - share), 0.0, 20.0, 3.0 * kParams.flat, 0.0, contour_area);
    AddWall(100.0 * (1.0 - share), 100.0, 0.0, 20.0, kParams.flat, 0.0, contour_area);
    const std::vector<double> heights = HeightsOf(contour_area);
    EXPECT_LE(WidestGap(heights), kMostGap * kParams.flat) << share;
    EXPECT_GE(heights.size(), 20.0 / (kMostGap * kParams.flat)) << share;
  }
}

TEST(LevelHeights, DoNotDependOnThreadsAndEndWhenCancelled) {
  ContourArea contour_area;
  Random random(6);
  for (int k = 0; k < 30; ++k) {
    const double z = random.Uniform(0.0, 12.0);
    AddWall(0.0, 10.0, z, z + random.Uniform(1.0, 6.0), random.Uniform(0.2, 1.6), 3.0 * k, contour_area);
  }
  EXPECT_EQ(LevelHeights(contour_area, kParams, RunContext(1))->heights,
            LevelHeights(contour_area, kParams, RunContext(8))->heights);
  RunContext stopped(2);
  stopped.Cancel();
  EXPECT_EQ(LevelHeights(contour_area, kParams, stopped).status().code(), absl::StatusCode::kCancelled);
}

TEST(LevelHeights, AreRefusedWhereThereAreTooMany) {
  ContourArea contour_area;
  AddWall(0.0, 10.0, 0.0, 10.0, 1e-4, 0.0, contour_area);
  HeightParams fine = kParams;
  fine.flat = 1e-4;
  fine.smallest = 2.5e-5;
  EXPECT_EQ(LevelHeights(contour_area, fine, RunContext(2)).status().code(),
            absl::StatusCode::kResourceExhausted);
}

TEST(LevelHeights, AreNoneWithoutSurface) { EXPECT_TRUE(HeightsOf({}).empty()); }

}  // namespace
}  // namespace patchmill
