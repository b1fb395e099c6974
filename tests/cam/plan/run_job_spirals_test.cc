// Whole jobs with spirals: the verifier's consent, an independent look at the program, and what they save.
#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

Job SpiralJob(Strategy strategy = Strategy::kAuto) {
  Job job = BallJob(3.0);
  job.operation.scallop = 0.03;
  job.operation.strategy = strategy;
  job.operation.spirals = true;
  return job;
}

std::size_t SpiralsOf(const JobResult& result) {
  std::size_t n = 0;
  for (const CutterPath& pass : result.motion.passes) n += pass.traversal == Traversal::kSpiral;
  return n;
}

void ExpectKept(const Surface& surface, const Job& job, std::size_t spirals) {
  const JobResult result = Mill(surface, job);
  ASSERT_TRUE(result.report.verify.ok()) << Describe(result);
  EXPECT_EQ(SpiralsOf(result), spirals) << Describe(result);
  Random random(11);
  CheckProgram(surface, job, result, random, 3000);
}

TEST(Spirals, DomeOnAPlane) {
  const Surface surface = PlacedSurface(Join({Sphere(Vec3::Zero(), 10, Half::kUpper), Plane(20)}));
  ExpectKept(surface, SpiralJob(), 1);
  Job conventional = SpiralJob();
  conventional.operation.contour_direction = CutDirection::kConventional;
  ExpectKept(surface, conventional, 1);
  const JobResult result = Mill(surface, conventional);
  for (const CutterPath& pass : result.motion.passes) {
    if (pass.traversal != Traversal::kSpiral) continue;
    EXPECT_GT(pass.points.front().center.z(), pass.points.back().center.z()) << "cut from the top";
    EXPECT_GT(Cross(Xy(pass.points[0].center), Xy(pass.points[1].center)), 0.0);
  }
}

TEST(Spirals, BlockTorusAndTwoDomes) {
  ExpectKept(PlacedSurface(Block(8, 5, 16)), SpiralJob(), 1);
  // The ring's outer side and its inner one.
  ExpectKept(PlacedSurface(Torus(Vec3::Zero(), 20, 6, Half::kUpper)), SpiralJob(), 2);
  // Levels above the saddle between the domes, where these are steep; then around both.
  const JobResult domes = Mill(PlacedSurface(TwoSpheres(10, 12)), SpiralJob(Strategy::kContour));
  EXPECT_TRUE(domes.report.verify.ok()) << Describe(domes);
  EXPECT_GE(SpiralsOf(domes), 3u);
}

TEST(Spirals, TakeTheMarksAway) {
  const Surface surface = PlacedSurface(Join({Sphere(Vec3::Zero(), 10, Half::kUpper), Plane(20)}));
  Job job = SpiralJob();
  const JobResult wound = Mill(surface, job);
  job.operation.spirals = false;
  const JobResult levels = Mill(surface, job);
  const auto contours = [](const JobResult& result) {
    std::size_t n = 0;
    for (const CutterPath& pass : result.motion.passes) n += pass.kind == PassKind::kContour;
    return n;
  };
  EXPECT_EQ(contours(wound), 1u);
  EXPECT_GT(contours(levels), 5u);
  // One turn more than there are levels, in place of the ways between them.
  EXPECT_LT(wound.report.verify.cut_length, 1.15 * levels.report.verify.cut_length);
}

// Contours that limits cut open have as few points as without spirals. A finding reports spirals that are
// not possible.
TEST(Spirals, CutOpenAreAsPlain) {
  const Surface surface = PlacedSurface(Join({Block(12, 10, 30), Plane(30)}));
  Job job = SpiralJob();
  job.operation.selection.boundary = {{{-30, 0}, {30, 0}, {30, 30}, {-30, 30}}};
  const auto findings = [](const JobResult& result) {
    return std::count_if(result.report.diagnostics.begin(), result.report.diagnostics.end(),
                         [](const Diagnostic& d) { return d.where.field == "contour_spirals"; });
  };
  const JobResult wound = Mill(surface, job);
  job.operation.spirals = false;
  const JobResult plain = Mill(surface, job);
  ASSERT_TRUE(wound.report.verify.ok()) << Describe(wound);
  EXPECT_EQ(SpiralsOf(wound), 0u);
  EXPECT_EQ(wound.report.point_count, plain.report.point_count);
  EXPECT_EQ(findings(wound), 1);
  EXPECT_EQ(findings(plain), 0);
}

// Half of the domes is cut open, one is whole.
TEST(Spirals, BesideContoursThatLimitsCut) {
  const Surface surface = PlacedSurface(
      Join({Sphere(Vec3(-15, 0, 0), 8, Half::kUpper), Sphere(Vec3(15, 0, 0), 8, Half::kUpper), Plane(40)}));
  Job job = SpiralJob();
  job.operation.selection.boundary = {{{-40, -20}, {15, -20}, {15, 20}, {-40, 20}}};
  const JobResult wound = Mill(surface, job);
  ASSERT_TRUE(wound.report.verify.ok()) << Describe(wound);
  EXPECT_EQ(SpiralsOf(wound), 1u);
  job.operation.spirals = false;
  EXPECT_LT(wound.report.point_count, 1.5 * Mill(surface, job).report.point_count);
}

// Random folded parts keep their promises with spirals wherever they come about.
TEST(Spirals, RandomParts) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Surface surface = PlacedSurface(RandomBspline(seed, {.spans = 4, .size = 16, .amplitude = 6}));
    Job job = SpiralJob(seed % 2 == 0 ? Strategy::kContour : Strategy::kAuto);
    job.operation.tool.cutter = BallEnd{1.0};
    const JobResult result = Mill(surface, job);
    EXPECT_TRUE(result.report.verify.ok()) << "seed " << seed << ": " << Describe(result);
  }
}

}  // namespace
}  // namespace patchmill
