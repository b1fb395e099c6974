// An area that forced passes do not finish is a region of its own. Its area is compared with closed forms,
// its leftover with the scallop of the shortest step, and an override changes how it is cut.
#include "cam/plan/forced_strategy.h"

#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/reach/forced_steps.h"
#include "cam/region/map/regions_digest.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kRadius = 3.0, kScallop = 0.02;
constexpr double kLeast = 0.25;  // PassParams::min_step_fraction

double FlatStep() { return 2.0 * std::sqrt(kScallop * (2.0 * kRadius - kScallop)); }

// Centre step on a convex circle of radius rho, as a part of the flat one, for small scallops
// ([spacing, section 1]).
double ConvexStep(double rho) { return std::sqrt(1.0 + kRadius / rho); }

Job ForcedJob(Strategy strategy, double angle = 0.0) {
  Job job = BallJob(kRadius);
  job.operation.scallop = kScallop;
  job.operation.strategy = strategy;
  job.operation.zigzag_angle = angle;
  return job;
}

ChosenRegions Regions(const Surface& surface, const Job& job) {
  auto regions = PlanRegions(surface, job, RunContext());
  EXPECT_TRUE(regions.ok()) << regions.status();
  return regions.ok() ? *std::move(regions) : ChosenRegions();
}

double AreaOf(const RegionMap& map, UnreachableReason reason) {
  double area = 0.0;
  for (const Region& region : map.regions) area += region.reason == reason ? region.area : 0.0;
  return area;
}

double StrategyArea(const RegionMap& map) { return AreaOf(map, UnreachableReason::kStrategy); }

double BorderLength(const RegionMap& map, BorderKind kind) {
  double length = 0.0;
  for (const BorderLine& line : map.border_lines) {
    if (line.kind != kind) continue;
    for (std::size_t i = 1; i < line.points.size(); ++i)
      length += (line.points[i] - line.points[i - 1]).norm();
    if (line.closed) length += (line.points.front() - line.points.back()).norm();
  }
  return length;
}

TEST(ForcedArea, ContoursLeaveTheCapOfASphere) {
  const double rho = 20.0, sine = kLeast / ConvexStep(rho), cosine = std::sqrt(1.0 - sine * sine);
  const Surface surface = PlacedSurface(Sphere(Vec3::Zero(), rho, Half::kUpper));
  const ChosenRegions regions = Regions(surface, ForcedJob(Strategy::kContour));
  const RegionMap& map = regions.map;
  const double cap = 2.0 * kPi * rho * rho * (1.0 - cosine);
  EXPECT_NEAR(StrategyArea(map), cap, 1e-6 * cap);
  EXPECT_NEAR(BorderLength(map, BorderKind::kStrategy), 2.0 * kPi * rho * sine, 0.01);
  EXPECT_NEAR(StrategyArea(map) + AreaOf(map, UnreachableReason::kNone), 2.0 * kPi * rho * rho, 1e-3);
  int caps = 0;
  for (const Region& region : map.regions) {
    if (region.reason != UnreachableReason::kStrategy) continue;
    ++caps;
    EXPECT_EQ(region.kind, RegionKind::kMountain);
    EXPECT_EQ(region.slope, SlopeClass::kGentle);
    EXPECT_GT(region.inside.z(), rho * cosine);
    EXPECT_GT(regions.figures[region.id.index()].step_min, 0.0);
    // At the summit no step is short enough. The nearest finished surface is the circle around it, sampled
    // in every second cell of 0.12 mm each way.
    const double away = std::hypot(rho - (rho + kRadius) * cosine, (rho + kRadius) * sine) - kRadius;
    EXPECT_GE(region.deepest_leftover, away - 0.25);
    EXPECT_LE(region.deepest_leftover, away + 0.25);
  }
  EXPECT_EQ(caps, 1);
}

// Of a cylinder along y, lines along y leave what is steep across them; lines along x leave nothing, for
// they run around it.
TEST(ForcedArea, LinesLeaveTheSidesOfACylinder) {
  const double rho = 12.0, half = 15.0;
  const Surface surface = PlacedSurface(Cylinder(Vec3::Zero(), rho, half, Half::kUpper));
  const RegionMap along = Regions(surface, ForcedJob(Strategy::kZigzag, kPi / 2.0)).map;
  const double steep = std::acos(kLeast / ConvexStep(rho));
  const double sides = 2.0 * (2.0 * half) * rho * (kPi / 2.0 - steep);
  EXPECT_NEAR(StrategyArea(along), sides, 1e-6 * sides);
  EXPECT_NEAR(BorderLength(along, BorderKind::kStrategy), 2.0 * 2.0 * half, 1e-6);
  for (const Region& region : along.regions) {
    if (region.reason == UnreachableReason::kStrategy) {
      EXPECT_EQ(region.slope, SlopeClass::kSteep);
    }
  }
  EXPECT_EQ(StrategyArea(Regions(surface, ForcedJob(Strategy::kZigzag, 0.0)).map), 0.0);
  EXPECT_EQ(StrategyArea(Regions(surface, ForcedJob(Strategy::kAuto, kPi / 2.0)).map), 0.0);
}

// Directions that are open are judged once they are chosen; the map is the same before, after, and for the
// verifier.
TEST(ForcedArea, OpenAngles) {
  const Surface surface = PlacedSurface(Cylinder(Vec3::Zero(), 12.0, 8.0, Half::kUpper));
  Job job = ForcedJob(Strategy::kZigzag, kPi / 2.0);
  const RegionMap given = Regions(surface, job).map;
  job.operation.angle_auto = true;
  const RegionMap open = Regions(surface, job).map;
  EXPECT_GT(StrategyArea(given), 0.0);
  EXPECT_EQ(StrategyArea(open), 0.0);
  EXPECT_EQ(RegionsDigest(given), RegionsDigest(open));
  const JobResult result = Mill(surface, job);
  EXPECT_EQ(RegionsDigest(result.regions), RegionsDigest(given));
  for (const Region& region : result.report.regions) {
    const bool kept = result.report.choices[region.id.index()].zigzag_angle == kPi / 2.0;
    const bool beyond = given.regions[region.id.index()].reason == UnreachableReason::kStrategy;
    EXPECT_EQ(region.reason == UnreachableReason::kStrategy, kept && beyond);
  }
  EXPECT_EQ(result.report.verify.unreachable_area[UncutReason::kStrategy] > 0.0,
            StrategyArea(result.regions) > 0.0);
}

// Scallops, of all or of one region, change no region.
TEST(ForcedArea, TheScallopChangesNoRegion) {
  const Surface surface = PlacedSurface(Sphere(Vec3::Zero(), 20.0, Half::kUpper));
  Job job = ForcedJob(Strategy::kContour);
  const std::string digest = RegionsDigest(Regions(surface, job).map);
  job.operation.scallop = 0.1;
  EXPECT_EQ(RegionsDigest(Regions(surface, job).map), digest);
  job.operation.strategy = Strategy::kAuto;
  EXPECT_NE(RegionsDigest(Regions(surface, job).map), digest);
}

// A plane below the least slope: all of it, and what stays is the scallop of the step that is taken.
TEST(ForcedArea, WhatStaysOnAPlane) {
  for (const double degrees : {8.0, 12.0, 16.0}) {
    const double sine = std::sin(Radians(degrees));
    const Surface surface = PlacedSurface(Plane(10.0, 0.0, std::tan(Radians(degrees))));
    const ChosenRegions regions = Regions(surface, ForcedJob(Strategy::kContour));
    ASSERT_EQ(regions.map.regions.size(), 1u);
    const Region& region = regions.map.regions[0];
    EXPECT_EQ(region.kind, RegionKind::kNeutral);
    EXPECT_EQ(region.slope, SlopeClass::kGentle);
    if (sine > kLeast) {
      EXPECT_EQ(region.reason, UnreachableReason::kNone);
      EXPECT_EQ(region.deepest_leftover, 0.0);
      continue;
    }
    EXPECT_EQ(region.reason, UnreachableReason::kStrategy);
    const double step = kLeast * FlatStep() / sine;
    const double left = kRadius - std::sqrt(kRadius * kRadius - 0.25 * step * step);
    EXPECT_NEAR(region.deepest_leftover, left, 1e-9);
    const JobResult result = Mill(surface, ForcedJob(Strategy::kContour));
    EXPECT_GT(result.report.verify.unreachable_area[UncutReason::kStrategy], 0.0) << Describe(result);
    EXPECT_LE(result.report.verify.unreachable_area[UncutReason::kStrategy], region.area) << Describe(result);
    EXPECT_NEAR(result.report.verify.deepest_unreachable[UncutReason::kStrategy], left, 0.02)
        << Describe(result);
  }
}

// Flats under contours and walls along the lines have no step at all.
TEST(ForcedArea, LeftByStepIsInfiniteWhereNoStepWillDo) {
  SurfaceJet jet;
  jet.du = Vec3::UnitX();
  jet.dv = Vec3::UnitY();
  const ForcedSteps contours{ForcedPasses::kContours, 0.0}, lines{ForcedPasses::kLines, 0.0};
  EXPECT_EQ(LeftByStep(contours, jet, Vec3::UnitZ(), {kRadius, kScallop}, kLeast), kInfinity);
  EXPECT_NEAR(LeftByStep(lines, jet, Vec3::UnitZ(), {kRadius, kScallop}, 1.0), kScallop, 1e-12);
  EXPECT_EQ(LeftByStep(lines, jet, Vec3::UnitZ(), {kRadius, kScallop}, kLeast), kScallop);
  EXPECT_EQ(LeftByStep({}, jet, Vec3::UnitZ(), {kRadius, kScallop}, kLeast), kScallop);
  jet.dv = Vec3::UnitZ();  // upright, normal -y
  EXPECT_EQ(LeftByStep(lines, jet, -Vec3::UnitY(), {kRadius, kScallop}, kLeast), kInfinity);
  EXPECT_NEAR(LeftByStep({ForcedPasses::kLines, kPi / 2.0}, jet, -Vec3::UnitY(), {kRadius, kScallop}, 1.0),
              kScallop, 1e-12);
}

// The remedy: that region by contours. It is cut, named so no longer, and the sum of the map is what it was.
TEST(ForcedArea, AnOverrideFinishesIt) {
  const double rho = 12.0;
  const Surface surface = PlacedSurface(Cylinder(Vec3::Zero(), rho, 15.0, Half::kUpper));
  Job job = ForcedJob(Strategy::kZigzag, kPi / 2.0);
  const ChosenRegions before = Regions(surface, job);
  const JobResult forced = Mill(surface, job);
  EXPECT_GT(forced.report.verify.unreachable_area[UncutReason::kStrategy], 0.0) << Describe(forced);
  EXPECT_LE(forced.report.verify.unreachable_area[UncutReason::kStrategy], 1.2 * StrategyArea(before.map));
  job.operation.regions_sha256 = RegionsDigest(before.map);
  for (const Region& region : before.map.regions) {
    if (region.reason != UnreachableReason::kStrategy) continue;
    RegionOverride change;
    change.region = region.id;
    change.strategy = Strategy::kContour;
    job.operation.overrides.push_back(change);
  }
  ASSERT_EQ(job.operation.overrides.size(), 2u);
  const JobResult after = Mill(surface, job);
  EXPECT_EQ(after.report.outcome, Outcome::kComplete) << Describe(after);
  EXPECT_EQ(after.report.verify.unreachable_area[UncutReason::kStrategy], 0.0) << Describe(after);
  EXPECT_EQ(RegionsDigest(after.regions), RegionsDigest(before.map));
  EXPECT_EQ(StrategyArea(after.regions), 0.0);
  // A scallop alone does not: its walls are as far beyond the lines as before.
  for (RegionOverride& change : job.operation.overrides) {
    change.strategy.reset();
    change.scallop = 0.03;
  }
  EXPECT_GT(StrategyArea(Regions(surface, job).map), 0.0);
}

}  // namespace
}  // namespace patchmill
