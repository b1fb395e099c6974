// Why a place is unreachable ([regions, section 6]): the region map and the verifier decide it by two
// programs, and agree.
#include <cmath>

#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/plan/resolve.h"
#include "cam/post/program_reader.h"
#include "tests/support/files.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

// A program that cuts nothing.
constexpr const char* kNothing =
    "G17 G21 G90 G94\nG53 G0 Z0\nT1 M6\nS1000 M3\nG43 H1\n"
    "G0 X0 Y0\nG0 Z900\nM9\nM5\nG53 G0 Z0\nM2\n";

using namespace testing;  // NOLINT: the support folder's

enum Reason { kUndercut, kConcave, kFloor, kReasons };

std::array<double, kReasons> FromRegions(const Surface& surface, const Job& job) {
  const auto regions = PlanRegions(surface, job, RunContext());
  EXPECT_TRUE(regions.ok()) << regions.status();
  std::array<double, kReasons> area{};
  for (const Region& region : regions->map.regions) {
    switch (region.reason) {
      case UnreachableReason::kUndercut:
        area[kUndercut] += region.area;
        break;
      case UnreachableReason::kConcave:
        area[kConcave] += region.area;
        break;
      case UnreachableReason::kFloor:
        area[kFloor] += region.area;
        break;
      default:
        EXPECT_NE(region.kind, RegionKind::kUnreachable);
    }
  }
  return area;
}

// Areas do not depend on the program: one that cuts nothing will do.
std::array<double, kReasons> FromVerifier(const Surface& surface, const Job& job) {
  const auto resolved = Resolve(surface, job, RunContext());
  EXPECT_TRUE(resolved.ok()) << resolved.status();
  const auto report = VerifyProgramText(surface, job.operation.tool, kNothing,
                                        MakeVerifyParams(job, *resolved), RunContext());
  EXPECT_TRUE(report.ok()) << report.status();
  // The map has no reason of its own for undersides.
  return {report->unreachable_area[UncutReason::kUndercut] + report->underside_area,
          report->unreachable_area[UncutReason::kConcave], report->unreachable_area[UncutReason::kFloor]};
}

void ExpectAgreement(const PatchModel& model, const Job& job) {
  const Surface surface = PlacedSurface(model, job.setup);
  const auto planned = FromRegions(surface, job), judged = FromVerifier(surface, job);
  // A strip as narrow as the tolerance between two reasons is below what the map resolves.
  const double strips = 0.0005 * (judged[kUndercut] + judged[kConcave] + judged[kFloor]);
  for (int reason = 0; reason < kReasons; ++reason) {
    const auto k = static_cast<std::size_t>(reason);
    EXPECT_NEAR(planned[k], judged[k], 0.01 * judged[k] + strips) << "reason " << reason;
  }
}

TEST(Reasons, ValleyOfTwoPlanes) {
  for (const double degrees : {20.0, 45.0}) {
    SCOPED_TRACE(degrees);
    ExpectAgreement(TwoPlanes(Radians(degrees), 12), BallJob(3.0));
  }
}

TEST(Reasons, ValleyWithFloor) { ExpectAgreement(TwoPlanes(Radians(30), 12), BallJob(3.0, /*deep=*/false)); }

TEST(Reasons, BlockWithVerticalWalls) {
  ExpectAgreement(Block(8, 10, 20), BallJob(3.0));
  ExpectAgreement(Block(8, 10, 20), BallJob(3.0, /*deep=*/false));
}

TEST(Reasons, FloorBesideATallWallIsConcave) {
  // The wall blocks ball and shank alike: a smaller ball would come closer.
  const Surface surface = PlacedSurface(Block(8, 10, 20));
  const Job job = BallJob(3.0);
  const auto area = FromRegions(surface, job);
  const double radius = 3.0, reach_tolerance = ReachTolerance(job.operation.tolerance);
  // On the floor: nearer to the footprint than R - g (the reach tolerance). On the walls: lower than that.
  const double reach = radius - reach_tolerance;
  const double strip = 4 * 16 * reach + kPi * reach * reach, walls = 4 * 16 * reach;
  EXPECT_EQ(area[kUndercut], 0.0);
  EXPECT_NEAR(area[kConcave], strip + walls, 0.01 * (strip + walls));
}

// What looks down on a closed block counts nowhere. Without one wall the block is a sheet, and nothing of it
// is left out of the areas.
TEST(Reasons, TheUndersideOfAClosedBlockDoesNotCount) {
  const double x = 30, y = 20, z = 12;
  const Job job = BallJob(3.0, /*deep=*/false);
  const auto judge = [&](const PatchModel& model) {
    const Surface surface = PlacedSurface(model, job.setup);
    const auto resolved = Resolve(surface, job, RunContext());
    EXPECT_TRUE(resolved.ok()) << resolved.status();
    const auto report = VerifyProgramText(surface, job.operation.tool, kNothing,
                                          MakeVerifyParams(job, *resolved), RunContext());
    EXPECT_TRUE(report.ok()) << report.status();
    return *report;
  };
  const double plan = 4 * x * y, walls = 4 * (x + y) * z;
  const VerifyReport closed = judge(ClosedBlock(x, y, z));
  EXPECT_NEAR(closed.underside_area, plan, 1e-6 * plan);
  EXPECT_NEAR(closed.total_area, plan + walls, 1e-6 * plan);
  PatchModel open = ClosedBlock(x, y, z);
  open.patches.pop_back();
  const VerifyReport sheet = judge(open);
  EXPECT_EQ(sheet.underside_area, 0.0);
  EXPECT_GT(sheet.total_area, 2 * plan);
}

// The inner side of a shell thinner than the ball: what is in the ball's way there is the outer side, but no
// ball, however small, gets there from above.
TEST(Reasons, TheUndersideOfAThinShellIsUndercut) {
  const PatchModel model =
      Join({Sphere(Vec3::Zero(), 12.0, Half::kUpper), Sphere(Vec3::Zero(), 11.0, Half::kUpper)});
  const Job job = BallJob(3.0);
  ExpectAgreement(model, job);
  const Surface surface = PlacedSurface(model);
  const double inner = 2.0 * kPi * 11.0 * 11.0;
  for (const auto& area : {FromRegions(surface, job), FromVerifier(surface, job)}) {
    EXPECT_NEAR(area[kUndercut], inner, 0.001 * inner);
    EXPECT_LT(area[kConcave], 0.001 * inner);
  }
}

// A plate a millimetre above a floor keeps the ball off it by itself: a smaller one would come no nearer but
// along the plate's edge.
TEST(Reasons, UnderAPlateIsUndercutAndBesideItConcave) {
  const double half = 10.0, reach_tolerance = ReachTolerance(0.01),
               under = 0.5 * SmallestBallRadius(reach_tolerance);
  const PatchModel model = Join({Plane(20.0), Plane(half, 1.0)});
  const Job job = BallJob(3.0);
  ExpectAgreement(model, job);
  const Surface surface = PlacedSurface(model);
  const auto grown = [&](double by) { return 4.0 * half * half + 8.0 * half * by + kPi * by * by; };
  // Its ball stands on the floor beside the plate, whose edge is 2 mm below the centre.
  const double tool = std::sqrt((3.0 - reach_tolerance) * (3.0 - reach_tolerance) - 4.0);
  for (const auto& area : {FromRegions(surface, job), FromVerifier(surface, job)}) {
    EXPECT_NEAR(area[kUndercut], grown(under), 0.01 * grown(under));
    const double beside = grown(tool) - grown(under);
    EXPECT_NEAR(area[kConcave], beside, 0.01 * beside);
  }
}

// Off the ends of a pipe the two reasons part at a flat angle: what is above the centre comes nearer than
// what is below by hardly more or less than counts, and a hundredth of a mm moves the border by a fifth of
// one.
TEST(Reasons, BesideAPipeOnAPlate) {
  const Eigen::Affine3d askew(Eigen::AngleAxisd(1.22, Vec3::UnitZ()));
  ExpectAgreement(Transformed(Join({Plane(12), Cylinder(Vec3(0, 0, 4), 4, 8)}), askew), BallJob(3.0));
}

// Two slots open to the top, narrower than the ball: what lies behind their walls, under the top, keeps no
// smaller ball from them. (Balls that pass the rib between the slots, and no farther, are blocked above.)
TEST(Reasons, WallsOfSlotsAreConcave) {
  const double half = 3.0, rib = 2.0, deep = 5.0, far = 20.0;
  PatchModel slots;
  for (const double side : {-1.0, 1.0}) {
    const auto quad = [&](double x0, double z0, double x1, double z1) {
      slots = Join({slots, Single(Bilinear({side * x0, -far, z0}, {side * x0, far, z0}, {side * x1, -far, z1},
                                           {side * x1, far, z1}))});
    };
    quad(0.0, deep, rib, deep);
    quad(rib, deep, rib, 0.0);
    quad(rib, 0.0, rib + 2.0 * half, 0.0);
    quad(rib + 2.0 * half, 0.0, rib + 2.0 * half, deep);
    quad(rib + 2.0 * half, deep, far, deep);
  }
  const Surface surface = PlacedSurface(slots);
  for (const double radius : {3.5, 10.0}) {
    const Job job = BallJob(radius);
    ExpectAgreement(slots, job);
    const double walls = 4.0 * 2.0 * far * deep, floors = 2.0 * 2.0 * far * 2.0 * half;
    for (const auto& area : {FromRegions(surface, job), FromVerifier(surface, job)}) {
      EXPECT_NEAR(area[kUndercut], 0.0, 1.0) << radius;
      EXPECT_NEAR(area[kConcave], walls + floors, 0.01 * (walls + floors)) << radius;
    }
  }
}

TEST(Reasons, Teacup) {
  Job job = BallJob(3.0, /*deep=*/false);
  job.setup.placement.scale = 50.0;
  job.setup.placement.up = UpAxis::kY;
  ExpectAgreement(LoadModel("tests/models/teacup.bpt"), job);
}

// Along the limit of an area that only the shank blocks, the ball alone fits. No strip of the area is
// CONCAVE.
TEST(Reasons, BesideOverhangsNothingIsConcave) {
  Job job = BallJob(3.0, /*deep=*/false);
  job.setup.placement.scale = 50.0;
  const PatchModel model = LoadModel("tests/models/toroidal_tet.patches");
  ExpectAgreement(model, job);
  const Surface surface = PlacedSurface(model, job.setup);
  for (const auto& area : {FromRegions(surface, job), FromVerifier(surface, job)}) {
    EXPECT_GT(area[kUndercut], 10'000.0);
    EXPECT_LT(area[kConcave], 0.1);
  }
}

TEST(Reasons, Teapot) {
  Job job = BallJob(3.0, /*deep=*/false);
  job.setup.placement.scale = 50.0;
  job.setup.placement.up = UpAxis::kY;
  ExpectAgreement(LoadModel("examples/teapot.bpt"), job);
}

}  // namespace
}  // namespace patchmill
