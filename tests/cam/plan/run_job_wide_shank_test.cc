// Shanks wider than the ball: what they keep the ball from in closed form, moves judged by plain geometry.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/clock.h"
#include "tests/support/jobs/limited_job.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

Job ShankJob(double shank_radius, double flutes, double ball = kLimitedRadius) {
  Job job = LimitedJob();
  job.operation.tool.cutter = BallEnd{ball};
  job.operation.tool.shank_diameter = 2.0 * shank_radius;
  job.operation.tool.flute_length = flutes;
  return job;
}

// Deepest of all sample points of the surface in the shank, at places half a millimetre apart on all moves.
double DeepestInShank(const Surface& surface, const Job& job, const JobResult& result) {
  const int cells = 2 + static_cast<int>(60.0 / std::sqrt(static_cast<double>(surface.pieces.size())));
  const double radius = 0.5 * *job.operation.tool.shank_diameter;
  const double rise = *job.operation.tool.flute_length - BallRadius(job.operation.tool);
  std::vector<Vec3> samples;
  for (const Piece& piece : surface.pieces) {
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells; ++j) {
        samples.push_back(Position(piece, static_cast<double>(i) / cells, static_cast<double>(j) / cells));
      }
    }
  }
  double deepest = -kInfinity;
  const auto& moves = result.motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    const Vec3 from = moves[i - 1].to, way = moves[i].to - from;
    const int places = 1 + static_cast<int>(way.norm() / 0.5);
    for (int k = 0; k < places; ++k) {
      const Vec3 c = from + way * (static_cast<double>(k) / places);
      for (const Vec3& p : samples) {
        deepest = std::max(deepest, std::min(radius - (Xy(p) - Xy(c)).norm(), p.z() - c.z() - rise));
      }
    }
  }
  return deepest;
}

// A block 16 high, flutes of 10: beside it the shank keeps the ball off the plate as far as it is wide, and
// off the wall where its lower end is below the top.
TEST(WideShank, KeepsOffABlock) {
  const double half = 8.0, top = 16.0, ball = 2.0, shank = 4.0, flutes = 10.0;
  const Surface surface = PlacedSurface(Block(half, top, 25));
  const Job job = ShankJob(shank, flutes, ball);
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  EXPECT_LE(DeepestInShank(surface, job, result), 0.011);
  // Between the rounded squares that ball and shank leave; at the wall from there up to the height of a
  // contact, that of the centre, at which the shank ends below the top.
  const double plate = 8.0 * half * (shank - ball) + kPi * (shank * shank - ball * ball);
  const double wall = 8.0 * half * (top - (flutes - ball) - ball);
  // Lower down the corner between wall and plate keeps the ball itself off.
  const double corner = 8.0 * half * ball;
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kShank], plate + wall,
              0.01 * (plate + wall));
  EXPECT_NEAR(AreaFor(result, UnreachableReason::kShank), plate + wall, 0.01 * (plate + wall));
  // The tip on the plate, the shank over the block.
  ASSERT_TRUE(result.report.verify.finishing_flute_length);
  const double named = *result.report.verify.finishing_flute_length;
  EXPECT_GE(named, top);
  EXPECT_LE(named, top + 0.0071);
  const JobResult longer = Mill(surface, ShankJob(shank, named, ball));
  ASSERT_EQ(longer.report.outcome, Outcome::kCompleteWhereReachable) << Describe(longer);
  EXPECT_EQ(longer.report.verify.unreachable_area[UncutReason::kShank], 0.0);
  EXPECT_FALSE(longer.report.verify.finishing_flute_length);
  EXPECT_NEAR(AreaFor(result, UnreachableReason::kConcave), corner + 8.0 * half * ball + kPi * ball * ball,
              0.02 * 2.0 * corner);
}

// The same with stock to leave: the shank keeps off by as much.
TEST(WideShank, KeepsTheStockToLeave) {
  const double half = 8.0, top = 16.0, ball = 2.0, shank = 4.0, flutes = 10.0, leave = 0.5;
  const Surface surface = PlacedSurface(Block(half, top, 25));
  Job job = ShankJob(shank, flutes, ball);
  job.operation.leave = leave;
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  EXPECT_LE(DeepestInShank(surface, job, result), 0.011 - leave);
}

// On a dome the shank of long flutes never touches, one of short flutes keeps the ball off the foot: a place
// whose normal stands at angle t from the axis is clear while the dome, shank.radius nearer to its axis, is
// below the shank's end.
TEST(WideShank, KeepsOffTheFootOfADome) {
  const double r = 12.0, ball = 2.0, shank = 3.0;
  const Surface surface = PlacedSurface(Sphere(Vec3::Zero(), r, Half::kUpper));
  const JobResult free = Mill(surface, ShankJob(shank, 30.0, ball));
  EXPECT_EQ(free.report.outcome, Outcome::kComplete) << Describe(free);
  const double flutes = 6.0, rise = flutes - ball;
  const auto room = [&](double t) {
    const double axis = std::max(0.0, (r + ball) * std::sin(t) - shank);
    return (r + ball) * std::cos(t) + rise - std::sqrt(r * r - axis * axis);
  };
  double low = 0.0, high = 0.5 * kPi;
  ASSERT_LT(room(high), 0.0);
  for (int i = 0; i < 60; ++i) (room(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  const double foot = 2.0 * kPi * r * r * std::cos(low);
  const Job job = ShankJob(shank, flutes, ball);
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kShank], foot, 0.01 * foot);
  EXPECT_NEAR(AreaFor(result, UnreachableReason::kShank), foot, 0.002 * foot);
  // The tip of the ball that touches the foot is a ball below it; the shank ends on the dome.
  const double over = r + ball - shank;
  ASSERT_TRUE(result.report.verify.finishing_flute_length);
  EXPECT_NEAR(*result.report.verify.finishing_flute_length, ball + std::sqrt(r * r - over * over) + 0.005,
              0.002);
  EXPECT_LE(DeepestInShank(surface, job, result), 0.011);
}

// Two margins at once: the ball's and the shank's from an avoided wall.
TEST(WideShank, KeepsTheMarginOfAvoidedPatches) {
  const double ball = 2.0, shank = 4.0, flutes = 10.0, margin = 1.0;
  PatchModel model = Join({Plane(20), Single(Bilinear({5, -20, 0}, {5, 20, 0}, {5, -20, 18}, {5, 20, 18}))});
  const Surface surface = PlacedSurface(model);
  Job job = ShankJob(shank, flutes, ball);
  job.operation.selection.avoid = {"#1"};
  job.operation.selection.avoid_margin = margin;
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  double least = kInfinity;
  for (const Move& move : result.motion.toolpath.moves) {
    if (move.to.z() + flutes - ball < 18.0 + margin - 0.01)
      least = std::min(least, std::abs(move.to.x() - 5.0));
  }
  EXPECT_NEAR(least, shank + margin, 0.02);
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kShank], 2.0 * 40.0 * (shank - ball), 2.0);
}

// A margin wider than what the flutes rise over the wall, and than the ball: the shank's counts all the
// same, on low rapids too.
TEST(WideShank, KeepsAMarginAboveItsFlutes) {
  const auto job_of = [](double flutes, double margin) {
    Job job = ShankJob(4.0, flutes, 2.0);
    job.operation.scallop = 0.1;
    job.operation.selection.avoid = {"#1"};
    job.operation.selection.avoid_margin = margin;
    return job;
  };
  const Surface high =
      PlacedSurface(Join({Plane(20), Single(Bilinear({5, -20, 0}, {5, 20, 0}, {5, -20, 17}, {5, 20, 17}))}));
  EXPECT_TRUE(Mill(high, job_of(20.0, 5.0)).report.verify.ok());
  const Surface low =
      PlacedSurface(Join({Plane(25), Single(Bilinear({5, -5, 0}, {5, 5, 0}, {5, -5, 5}, {5, 5, 5}))}));
  Job job = job_of(4.0, 6.0);
  job.setup.allowance_stated = true;
  job.operation.clearance_above = 12.0;
  const JobResult result = Mill(low, job);
  EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
}

// A shank that ends a few microns below the top of a block, over the whole flat around it.
TEST(WideShank, FlatSurfaceAlongItsLimitCostsLittle) {
  const Surface surface = PlacedSurface(Block(6, 16, 14));
  for (const double below : {0.0005, 0.0055, 0.0065}) {
    SCOPED_TRACE(below);
    const double before = ClockSeconds(CLOCK_PROCESS_CPUTIME_ID);
    const JobResult result = Mill(surface, ShankJob(4.0, 16.0 - below, 2.0));
    EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
    const double area = result.report.verify.unreachable_area[UncutReason::kShank];
    // On the walls it is a strip thinner than the tolerance: the map gives it to CONCAVE beside it, and the
    // report sees it in cells.
    EXPECT_NEAR(AreaFor(result, UnreachableReason::kShank), area, 0.02 * area);
    EXPECT_NEAR(AreaFor(result, UnreachableReason::kShank), 96.0 + 12.0 * kPi, 0.5);  // 2 to 4 off the walls
    if (!kSanitized) {
      EXPECT_LT(ClockSeconds(CLOCK_PROCESS_CPUTIME_ID) - before, 15.0);
    }
  }
}

// Random sheets under random shanks: verified, and what was refused before has a program.
TEST(WideShank, RandomSheets) {
  Random random(11);
  int limited = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const Surface surface = PlacedSurface(RandomBspline(seed, {.spans = 5, .size = 24.0, .amplitude = 7.0}));
    Job job = ShankJob(random.Uniform(2.5, 6.0), random.Uniform(2.0, 8.0), 2.0);
    job.operation.scallop = 0.03;
    const JobResult result = Mill(surface, job);
    ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
    EXPECT_LE(DeepestInShank(surface, job, result), 0.011);
    const double area = result.report.verify.unreachable_area[UncutReason::kShank];
    EXPECT_NEAR(AreaFor(result, UnreachableReason::kShank), area, 0.01 * area + 1.0);
    limited += area > 1.0;
  }
  EXPECT_GE(limited, 2);
}

TEST(WideShank, WhereNothingIsLeftItIsNamed) {
  const Surface surface = PlacedSurface(Block(8, 30, 20));
  Job job = ShankJob(40.0, 0.5, 2.0);
  job.operation.selection.boundary = {RingOfBox(10, -20, 20, 20)};
  job.operation.selection.boundary_mode = BoundaryMode::kContact;
  const JobResult result = Mill(surface, job);
  EXPECT_EQ(result.report.outcome, Outcome::kNothingToCut);
  const auto& found = result.report.diagnostics;
  EXPECT_TRUE(std::any_of(found.begin(), found.end(), [](const Diagnostic& d) {
    return d.code == "NOTHING_TO_CUT" &&
           d.message.find("% of it is SHANK): check the length of flutes") != std::string::npos;
  }));
}

}  // namespace
}  // namespace patchmill
