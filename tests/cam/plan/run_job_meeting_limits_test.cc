// Limits of an operation that meet or run beside walls: sharp corners, areas without a width, walls that are
// free on one side and allowed on the other.
#include <cmath>

#include <gtest/gtest.h>

#include "core/io/model_text.h"
#include "tests/support/files.h"
#include "tests/support/fuzz.h"
#include "tests/support/jobs/limited_job.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// On the wall y = 10 of a block a ball outside is not allowed, and one inside is not free: nobody reaches
// it, though it is free on one side and allowed on the other.
TEST(MeetingLimits, UprightWallsAreReachedFromASideThatIsFreeAndAllowed) {
  const Surface surface = PlacedSurface(Block(10, 10, 30));
  Job job = LimitedJob();
  job.operation.selection.boundary = {RingOfBox(-20, -20, 20, 11)};
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  // The floor: all of it, less what lies beside the block (CONCAVE) or under allowed centres. Of the strip
  // beside the block these have what the line y = 11 leaves.
  const double beside = 4 * 20 * kLimitedRadius + kPi * kLimitedRadius * kLimitedRadius;
  const double corner = std::sqrt(kLimitedRadius * kLimitedRadius - 1) +
                        kLimitedRadius * kLimitedRadius * std::asin(1 / kLimitedRadius);
  const double allowed =
      40 * 31 - 20 * 20 -
      (3 * 20 * kLimitedRadius + 0.5 * kPi * kLimitedRadius * kLimitedRadius + 20 + corner);
  const double wall = 20 * (10 - kLimitedRadius);
  const double avoided = 60 * 60 - 20 * 20 - beside - allowed + wall;
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kAvoided], avoided, 2.0);
  double map = 0.0;
  for (const Region& r : result.report.regions) {
    if (r.reason == UnreachableReason::kAvoided) map += r.area;
  }
  EXPECT_NEAR(map, avoided, 2.0);
}

// Corners of some degrees, on slopes that pass them at any angle, and between a clamp and the sheet's edge.
TEST(MeetingLimits, SharpCornersOfWhatIsAllowedAreFinished) {
  const Surface slope = PlacedSurface(Plane(30, 0, 0.577));
  const Surface dome = PlacedSurface(Paraboloid(-0.01, 30));
  Job job = LimitedJob();
  job.operation.scallop = 0.03;
  Random random(5);
  int cut = 0;
  const auto mill = [&](const Surface& surface) {
    const JobResult result = Mill(surface, job);
    EXPECT_TRUE(result.report.outcome == Outcome::kCompleteWhereReachable ||
                result.report.outcome == Outcome::kNothingToCut)
        << Describe(result);
    cut += result.report.outcome == Outcome::kCompleteWhereReachable;
  };
  const int corners = kSanitized ? 6 : CountOf(16, 60), clamps = kSanitized ? 2 : CountOf(4, 10);
  for (int i = 0; i < corners; ++i) {
    Ring ring;
    for (int k = 0; k < 3; ++k) ring.push_back({random.Uniform(-30, 30), random.Uniform(-30, 30)});
    job.operation.selection.boundary = {ring};
    SCOPED_TRACE(::testing::Message() << i << ": " << ring[0].transpose() << ", " << ring[1].transpose()
                                      << ", " << ring[2].transpose());
    mill(i % 2 == 0 ? slope : dome);
  }
  job.operation.selection.boundary.clear();
  for (int i = 0; i < clamps; ++i) {
    const double a = random.Uniform(0.02, 0.2);
    job.setup.obstacles = {{"clamp", {{-40, -25}, {40, -25 + 80 * a}, {40, -60}, {-40, -60}}, 60.0, 0.0}};
    SCOPED_TRACE(::testing::Message() << "clamp " << a);
    mill(i % 2 == 0 ? slope : dome);
  }
  EXPECT_GE(4 * cut, 3 * (corners + clamps));
}

// A boundary that touches the sheet, or itself, from outside. An area without a width need not be finished.
TEST(MeetingLimits, WhereLimitsTouchNothingIsAskedFor) {
  const Surface surface = PlacedSurface(Plane(20));
  Job job = LimitedJob();
  const std::vector<std::vector<Ring>> boundaries = {
      {RingOfBox(20, -15, 40, 10)},
      {RingOfBox(20, -15, 40, 10), RingOfBox(-15, -15, 0, 15)},
      {RingOfBox(-15, -15, 5, 15), RingOfBox(-5, -15, 15, 15)},
      {RingOfBox(-15, -15, 5, 15), RingOfBox(-15, -15, 5, 15)},
  };
  for (std::size_t i = 0; i < boundaries.size(); ++i) {
    job.operation.selection.boundary = boundaries[i];
    const JobResult result = Mill(surface, job);
    EXPECT_TRUE(result.report.outcome == Outcome::kCompleteWhereReachable ||
                result.report.outcome == Outcome::kNothingToCut)
        << i << " " << Describe(result);
  }
}

// The boundary runs a radius beside the walls, as users draw it, so that every centre lies on it. The walls
// are cut, and the verifier reports one that is not.
TEST(MeetingLimits, WallsWithTheBoundaryARadiusBesideThemAreAskedFor) {
  const Surface surface = PlacedSurface(Block(10, 10, 30));
  const double beside = 10 + kLimitedRadius;
  Job job = LimitedJob();
  job.operation.selection.boundary = {RingOfBox(-beside, -beside, beside, beside)};
  EXPECT_EQ(Mill(surface, job).report.outcome, Outcome::kCompleteWhereReachable);
  Job top = LimitedJob();
  top.operation.selection.patches = {"#4"};
  const JobResult flat = Mill(surface, top);
  ASSERT_TRUE(flat.report.verify.ok()) << Describe(flat);
  VerifyParams params;
  params.finish.scallop = job.operation.scallop;
  params.floor_z = -1000.0;
  params.stock_top_z = 10.5;
  params.containment.boundary = {Outline(job.operation.selection.boundary), BoundaryMode::kCenter, 0.0};
  const auto report = VerifyProgramText(surface, job.operation.tool, flat.program, params, RunContext());
  ASSERT_TRUE(report.ok()) << report.status();
  bool on_wall = false;
  for (const Diagnostic& d : report->findings)
    on_wall |= d.code == "LEFTOVER" && d.where.point && d.where.point->z() > 1.0 && d.where.point->z() < 9.0;
  EXPECT_TRUE(on_wall);
}

// The ball beside the wall keeps the floor's margin by its height alone.
TEST(MeetingLimits, WallsOverAnAvoidedFloorKeepItsMargin) {
  const Surface surface = PlacedSurface(Block(10, 10, 30));
  for (const double margin : {0.0, 1.0, 4.0}) {
    Job job = LimitedJob();
    job.operation.selection.avoid = {"#0", "#1", "#2", "#3", "#5", "#6", "#7", "#8"};  // #4 is the top
    job.operation.selection.avoid_margin = margin;
    const JobResult result = Mill(surface, job);
    ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << margin << " " << Describe(result);
    // The ball's lowest centre beside the wall is a radius and the margin over the floor.
    EXPECT_NEAR(result.report.verify.reachable_area, 20 * 20 + 4 * 20 * (10 - kLimitedRadius - margin), 3.0)
        << margin;
  }
}

// The handle stands upright beside what is avoided: the ball's own contact there is one of many along the
// shank, and the crease on which most of the rest is cut is not allowed.
TEST(MeetingLimits, WallsBesideAvoidedPatchesAreFinished) {
  const auto model = ReadModelText("bpt", ReadRepositoryFile("examples/teapot.bpt"));
  ASSERT_TRUE(model.ok()) << model.status();
  patchmill::Setup setup;
  setup.placement.scale = 30.0;
  setup.placement.up = UpAxis::kY;
  const Surface surface = PlacedSurface(*model, setup);
  for (const double margin : {0.0, 0.5}) {
    Job job = BallJob(5.0, false);
    job.operation.scallop = 0.05;
    job.operation.leave = 0.1;
    job.operation.selection.avoid = {"#5", "#2", "#20", "#9", "#25", "#7", "#18", "#10"};
    job.operation.selection.avoid_margin = margin;
    const JobResult result = Mill(surface, job);
    EXPECT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << margin << " " << Describe(result);
  }
}

}  // namespace
}  // namespace patchmill
