// Unreachable area for a list of radii against closed forms.
#include "cam/region/figures/reach_table.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/region/split_regions.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's
using ::testing::HasSubstr;

ReachTableResult Table(const Surface& surface, const ReachTableParams& params) {
  auto table = ReachTable(surface, params, RunContext());
  EXPECT_TRUE(table.ok()) << table.status();
  return *std::move(table);
}

TEST(ReachTable, ValleyOfTwoPlanes) {
  // A ball in a V of slope a touches each plane R tan(a) from the bottom. The reach tolerance g lets it come
  // nearer by g / sin(2 a): the ball of R - g that stands as if it had the radius R must be free.
  const double a = Radians(30), half = 12;
  ReachTableParams params;
  params.radii = {0.5, 1.0, 2.0, 4.0};
  const auto table = Table(SurfaceOf(TwoPlanes(a, half)), params);
  ASSERT_EQ(table.unreachable.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const double r = params.radii[k];
    const double nearest = r * std::tan(a) - ReachTolerance(params.tolerance) / std::sin(2 * a);
    const double area = 2 * nearest * 2 * half;
    EXPECT_NEAR(table.unreachable[k], area, 0.01 * r * 2 * 2 * half) << r;  // of each of the two limits
  }
}

TEST(ReachTable, ParabolicValleyIsReachedUpToItsRadius) {
  // z = x^2 / 8: radius 4 at the bottom.
  ReachTableParams params;
  params.radii = {1.0, 2.0, 3.9, 6.0};
  const auto table = Table(SurfaceOf(ParabolicValley(0.125, 6)), params);
  EXPECT_EQ(table.unreachable[0], 0.0);
  EXPECT_EQ(table.unreachable[1], 0.0);
  EXPECT_EQ(table.unreachable[2], 0.0);
  EXPECT_GT(table.unreachable[3], 12.0);
}

TEST(ReachTable, HasTheAreasOfTheRegionMap) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const Surface surface = SurfaceOf(RandomBspline(seed, {.amplitude = 8.0, .folds = seed == 3}));
    ReachTableParams params;
    params.radii = {0.8, 2.0, 4.0};
    params.floor_z = surface.box.min.z();
    const auto table = Table(surface, params);
    for (std::size_t k = 0; k < params.radii.size(); ++k) {
      RegionParams region;
      region.radius = params.radii[k];
      region.tolerance = params.tolerance;
      region.floor_z = params.floor_z;
      const auto map = SplitRegions(surface, region, RunContext());
      ASSERT_TRUE(map.ok()) << map.status();
      double left = 0.0;
      for (const Region& r : map->regions) left += r.kind == RegionKind::kUnreachable ? r.area : 0.0;
      EXPECT_GT(left, 0.0);
      EXPECT_NEAR(table.unreachable[k], left, 0.003 * left + 0.05) << params.radii[k];
    }
  }
}

TEST(ReachTable, FloorCountsAndGrowsWithTheRadius) {
  // Hemisphere on its floor: the tip is below z = 0 where e_z < R / (10 + R), a band of 2 pi 100 e_z.
  ReachTableParams params;
  params.radii = {1.0, 3.0};
  params.floor_z = 0.0;
  const auto table = Table(SurfaceOf(Sphere(Vec3::Zero(), 10, Half::kUpper)), params);
  for (std::size_t k = 0; k < 2; ++k) {
    const double r = params.radii[k], band = 2 * kPi * 100 * r / (10 + r);
    EXPECT_NEAR(table.unreachable[k], band, 0.01 * band) << r;
  }
  EXPECT_NEAR(table.area, 2 * kPi * 100, 1e-6 * table.area);
  EXPECT_NEAR(table.largest[0], table.unreachable[1] - table.unreachable[0], 1e-9 * table.area);
  EXPECT_NEAR(table.largest[1], table.area - table.unreachable[1], 1e-9 * table.area);
}

TEST(ReachTable, RefusesNonsense) {
  const Surface surface = SurfaceOf(Plane(5));
  const auto message = [&](std::vector<double> radii, double tolerance) {
    ReachTableParams params;
    params.radii = std::move(radii);
    params.tolerance = tolerance;
    const auto table = ReachTable(surface, params, RunContext());
    EXPECT_EQ(table.status().code(), absl::StatusCode::kInvalidArgument);
    return std::string(table.status().message());
  };
  EXPECT_THAT(message({}, 0.01), HasSubstr("radii: 0 given; must be 1 to 64"));
  EXPECT_THAT(message({1, 1}, 0.01), HasSubstr("radii[1] = 1; must be finite and above 1"));
  EXPECT_THAT(message({-1}, 0.01), HasSubstr("radii[0] = -1"));
  EXPECT_THAT(message({1, 2}, 0.5), HasSubstr("tolerance = 0.5; must be in (0, 0.5)"));
}

TEST(ReachTable, CancelIsObeyed) {
  RunContext run;
  run.Cancel();
  ReachTableParams params;
  params.radii = {1.0};
  EXPECT_EQ(ReachTable(SurfaceOf(Plane(5)), params, run).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
