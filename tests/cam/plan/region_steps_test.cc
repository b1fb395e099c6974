// The steps that regions report are those of the two-circle formula on shapes of constant curvature.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// Two balls of radius R on a circle of radius rho, scallop s: cos of the angle between the centres' rays and
// the crest's, by the cosine rule; the centres lie on the circle of radius rho + R ([spacing (2)]).
double StepOnConvex(double rho, double radius, double scallop) {
  const double c = rho + radius, crest = rho + scallop;
  const double half = std::acos((c * c + crest * crest - radius * radius) / (2.0 * c * crest));
  return 2.0 * half * c;
}

void ExpectSteps(const PatchModel& model, const Job& job, double step) {
  const auto regions = PlanRegions(PlacedSurface(model), job, RunContext());
  ASSERT_TRUE(regions.ok()) << regions.status();
  int reachable = 0;
  for (const Region& region : regions->map.regions) {
    const RegionFigures& figures = regions->figures[region.id.index()];
    if (region.kind == RegionKind::kUnreachable) {
      EXPECT_EQ(figures.step_max, 0.0);
      continue;
    }
    ++reachable;
    EXPECT_NEAR(figures.step_min, step, 1e-9) << region.id.value;
    EXPECT_NEAR(figures.step_max, step, 1e-9) << region.id.value;
  }
  EXPECT_GT(reachable, 0);
}

TEST(RegionSteps, SphereWhateverTheStrategy) {
  for (const Strategy strategy : {Strategy::kAuto, Strategy::kContour, Strategy::kZigzag}) {
    Job job = BallJob(3.0);
    job.operation.strategy = strategy;
    ExpectSteps(Sphere(Vec3::Zero(), 10, Half::kUpper), job, StepOnConvex(10, 3, job.operation.scallop));
  }
}

TEST(RegionSteps, CylinderAlongAndAcross) {
  Job job = BallJob(3.0);
  job.operation.strategy = Strategy::kZigzag;
  const double s = job.operation.scallop;
  // Axis along y. Feed along x runs round it: flat across. Feed along y: round across.
  job.operation.zigzag_angle = 0.0;
  ExpectSteps(Cylinder(Vec3::Zero(), 10, 10, Half::kUpper), job, 2.0 * std::sqrt(6.0 * s - s * s));
  job.operation.zigzag_angle = kPi / 2.0;
  ExpectSteps(Cylinder(Vec3::Zero(), 10, 10, Half::kUpper), job, StepOnConvex(10, 3, s));
}

// The cap of a dome that merging leaves in its flank has lines, unless one strategy is forced; where it is a
// region of its own, nothing is cut otherwise but cells along the border.
TEST(RegionSteps, WhatMergingLeftIsCutOtherwise) {
  const Surface dome = PlacedSurface(Sphere(Vec3::Zero(), 10, Half::kUpper));
  const auto area_of = [&](double steep, Strategy strategy, std::size_t regions) {
    Job job = BallJob(3.0);
    job.operation.steep_angle = Radians(steep);
    job.operation.strategy = strategy;
    const auto planned = PlanRegions(dome, job, RunContext());
    EXPECT_TRUE(planned.ok()) << planned.status();
    double area = 0.0;
    std::size_t reachable = 0;
    for (const Region& region : planned->map.regions) {
      const RegionFigures& figures = planned->figures[region.id.index()];
      reachable += region.kind != RegionKind::kUnreachable;
      area += region.area * figures.otherwise_share;
    }
    EXPECT_EQ(reachable, regions);
    return area;
  };
  const double cap = 2.0 * kPi * 100.0 * (1.0 - std::cos(Radians(8.0)));
  EXPECT_NEAR(area_of(8.0, Strategy::kAuto, 1), cap, 0.1 * cap);  // few points of it
  EXPECT_EQ(area_of(8.0, Strategy::kContour, 2), 0.0);
  EXPECT_EQ(area_of(8.0, Strategy::kZigzag, 2), 0.0);
  EXPECT_LT(area_of(45.0, Strategy::kAuto, 2), 0.01 * 2.0 * kPi * 100.0);
}

TEST(RegionSteps, NoneWhereTheBallDoesNotFit) {
  // A parabolic valley of radius 2 at the bottom: steps shrink to nothing towards the spot of radius 3.
  Job job = BallJob(3.0);
  job.operation.strategy = Strategy::kZigzag;
  job.operation.zigzag_angle = kPi / 2.0;  // along the valley
  const auto regions = PlanRegions(PlacedSurface(ParabolicValley(0.25, 8)), job, RunContext());
  ASSERT_TRUE(regions.ok()) << regions.status();
  const double flat = 2.0 * std::sqrt(6.0 * job.operation.scallop);
  bool seen = false;
  for (const Region& region : regions->map.regions) {
    const RegionFigures& figures = regions->figures[region.id.index()];
    if (region.kind == RegionKind::kUnreachable) continue;
    seen = true;
    EXPECT_GT(figures.step_min, 0.0);
    EXPECT_LE(figures.step_min, figures.step_max);
    EXPECT_LT(figures.step_max, flat);
  }
  EXPECT_TRUE(seen);
}

double LeastFeedOf(const PatchModel& model, const Job& job) {
  const JobResult result = Mill(PlacedSurface(model), job);
  EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
  EXPECT_GT(result.report.verify.cut_length, result.report.least_cut_length);
  return result.report.least_cut_length;
}

TEST(LeastCutLength, IsTheAreaOfTheCentersOverTheWidestStep) {
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  const double s = job.operation.scallop, flat = 2.0 * std::sqrt(6.0 * s - s * s);
  EXPECT_NEAR(LeastFeedOf(Plane(8), job), 256.0 / flat, 1e-6);
  // Every direction bends alike; the centres lie on the sphere of radius 13. The rim is cut off in cells.
  const double dome = 2.0 * kPi * 13.0 * 13.0 / StepOnConvex(10, 3, s);
  EXPECT_NEAR(LeastFeedOf(Sphere(Vec3::Zero(), 10, Half::kUpper), job), dome, 4e-3 * dome);
  // Round one way: the widest step is that between lines along the axis, whichever way they run.
  const double shell = kPi * 13.0 * 20.0 / StepOnConvex(10, 3, s);
  EXPECT_NEAR(LeastFeedOf(Cylinder(Vec3::Zero(), 10, 10, Half::kUpper), job), shell, 2e-3 * shell);
}

TEST(LeastCutLength, LeavesOutWhatForcedPassesLeave) {
  // Contours on a dome, whose step is the same all over and seen under the slope: its cap wants steps below a
  // quarter of the flat one.
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  job.operation.strategy = Strategy::kContour;
  const double s = job.operation.scallop, flat = 2.0 * std::sqrt(6.0 * s - s * s);
  const double step = StepOnConvex(10, 3, s), cap = std::asin(0.25 * flat / step);
  const double zone = 2.0 * kPi * 13.0 * 13.0 * std::cos(cap) / step;
  EXPECT_NEAR(LeastFeedOf(Sphere(Vec3::Zero(), 10, Half::kUpper), job), zone,
              8e-3 * zone);  // two limits in cells
}

TEST(LeastCutLength, DoesNotDependOnHowManyPatchesThereAre) {
  // A level plane of 20 x 20 spline patches: few points of each are looked at.
  PatchModel plane;
  plane.patches.push_back(
      {"", InterpolatedHeights([](double, double) { return 0.0; }, 0.0, 16.0, 0.0, 16.0, 20, 20)});
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  const double s = job.operation.scallop;
  EXPECT_NEAR(LeastFeedOf(plane, job), 256.0 / (2.0 * std::sqrt(6.0 * s - s * s)), 1e-6);
}

TEST(LeastCutLength, LeavesOutSkippedRegions) {
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  const Surface dome = PlacedSurface(Sphere(Vec3::Zero(), 10, Half::kUpper));
  const double all = Mill(dome, job).report.least_cut_length;
  RegionOverride& cap = job.operation.overrides.emplace_back();  // the gentle one, above 45 degrees
  cap.at = Vec3(0, 0, 10);
  cap.skip = true;
  const double share = std::cos(job.operation.steep_angle);
  EXPECT_NEAR(Mill(dome, job).report.least_cut_length, all * share, 0.01 * all);
}

// The map is that of the whole part, whatever is selected.
TEST(WantedShare, IsWhatIsSelectedOfARegion) {
  const Surface surface = PlacedSurface(Plane(12));
  const auto shares = [&](auto select) {
    Job job = BallJob(3.0);
    select(job.operation.selection);
    const auto regions = PlanRegions(surface, job, RunContext());
    EXPECT_TRUE(regions.ok()) << regions.status();
    EXPECT_EQ(regions->map.regions.size(), 1u);
    return regions->figures[0].selected_share;
  };
  EXPECT_EQ(shares([](Selection&) {}), 1.0);
  EXPECT_EQ(shares([](Selection& s) { s.avoid = {"#0"}; }), 0.0);
  EXPECT_NEAR(shares([](Selection& s) {
                s.boundary = {{{-12, -12}, {6, -12}, {6, 12}, {-12, 12}}};
                s.boundary_mode = BoundaryMode::kContact;
              }),
              0.75, 0.01);
}

TEST(LeastCutLength, LeavesOutWhatIsNotSelected) {
  const Surface surface = PlacedSurface(TwoPlanes(Radians(20), 12));
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  const double all = Mill(surface, job).report.least_cut_length;
  job.operation.selection.patches = {"#1"};
  EXPECT_NEAR(Mill(surface, job).report.least_cut_length, 0.5 * all, 0.02 * all);
}

}  // namespace
}  // namespace patchmill
