// Zig-zag lines that run one way only, through the whole chain.
#include <cmath>

#include <gtest/gtest.h>

#include "cam/plan/region_choices.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

Job LinesJob() {
  Job job = BallJob(3.0);
  job.operation.scallop = 0.02;
  return job;
}

// Zig-zag moves along and against the direction.
std::pair<int, int> Senses(const JobResult& result, double angle) {
  const Vec2 along(std::cos(angle), std::sin(angle));
  std::pair<int, int> count{0, 0};
  const auto& moves = result.motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (moves[i].kind != MoveKind::kCut) continue;
    if (result.motion.passes[static_cast<std::size_t>(moves[i].pass)].kind != PassKind::kZigzag) continue;
    const double forward = Xy(moves[i].to - moves[i - 1].to).dot(along);
    ++(forward > 0.0 ? count.first : count.second);
  }
  return count;
}

TEST(OneWayLines, AllRunInTheirDirection) {
  const double angle = Radians(200.0);
  const Surface surface = PlacedSurface(RandomBspline(3, {.spans = 4, .size = 20.0, .amplitude = 1.0}));
  Job job = LinesJob();
  job.operation.zigzag_angle = angle;
  const JobResult both = Mill(surface, job);
  ASSERT_FALSE(both.program.empty()) << Describe(both);
  EXPECT_GT(Senses(both, angle).second, 0);
  job.operation.one_way = true;
  const JobResult one = Mill(surface, job);
  ASSERT_FALSE(one.program.empty()) << Describe(one);
  EXPECT_GT(Senses(one, angle).first, 100);
  EXPECT_EQ(Senses(one, angle).second, 0);
  int lines = 0;
  for (const CutterPath& pass : one.motion.passes) lines += pass.kind == PassKind::kZigzag ? 1 : 0;
  EXPECT_GE(one.report.motion.retract_count, lines);
  Random random(7);
  CheckProgram(surface, job, one, random, 400);
}

TEST(OneWayLines, OfOneRegionAlone) {
  PatchModel model = Plane(8);
  for (Patch& patch : Transformed(Plane(8), Eigen::Affine3d(Eigen::Translation3d(40, 0, 0))).patches) {
    model.patches.push_back(patch);
  }
  Job job = LinesJob();
  RegionOverride change;
  change.at = Vec3(40, 0, 0);
  change.one_way = true;
  job.operation.overrides = {change};
  const JobResult result = Mill(PlacedSurface(model), job);
  ASSERT_EQ(result.report.outcome, Outcome::kComplete) << Describe(result);
  int back[2] = {0, 0};
  const auto& moves = result.motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    if (moves[i].kind != MoveKind::kCut) continue;
    if (moves[i].to.x() < moves[i - 1].to.x()) ++back[moves[i].to.x() > 20.0 ? 1 : 0];
  }
  EXPECT_GT(back[0], 0);
  EXPECT_EQ(back[1], 0);
}

}  // namespace
}  // namespace patchmill
