// A patch of every kind, and a joined model of Gregory triangles, through the whole chain: verified, and
// judged from the program's text.
#include <gtest/gtest.h>

#include "tests/support/files.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kSize = 4.0;  // mm

// The random kinds are bumpy: some have dents that a ball of 0.4 does not reach.
std::vector<PatchShape> Kinds() {
  std::vector<PatchShape> kinds = SingularKinds(kSize);
  kinds.push_back(RandomHosaka(12, 3, false, false, kSize));
  kinds.push_back(RandomHosaka(13, 4, true, true, kSize));
  HosakaPatch linear = RandomHosaka(14, 5, false, false, kSize);
  linear.blend = HosakaPatch::Blend::kLinear;
  kinds.push_back(linear);
  kinds.push_back(RandomBrown(15, 3, 4, kSize, {0.3, 0.7}, {0.55}));
  return kinds;
}

class PatchKinds : public ::testing::TestWithParam<std::size_t> {};

TEST_P(PatchKinds, ArePlannedAndVerified) {
  const Surface surface = PlacedSurface(Single(Kinds()[GetParam()]));
  Job job = BallJob(0.4);
  job.operation.scallop = 0.05;
  const JobResult result = Mill(surface, job);
  Random random(GetParam());
  CheckProgram(surface, job, result, random, kSanitized ? 50 : 300);
  EXPECT_GT(result.report.verify.reachable_area, 0.5 * result.report.verify.total_area) << Describe(result);
}

INSTANTIATE_TEST_SUITE_P(All, PatchKinds,
                         ::testing::Range(std::size_t{0}, Kinds().size(), std::size_t{kSanitized ? 3 : 1}));

TEST(GregoryTriangles, OfSubdivisionMill) {
  Job job = BallJob(2.0);
  job.setup.placement.scale = 15.0;
  const Surface surface = PlacedSurface(LoadModel("tests/models/saddle.patches"), job.setup);
  const JobResult result = Mill(surface, job);
  Random random(1);
  CheckProgram(surface, job, result, random, kSanitized ? 50 : 300);
}

}  // namespace
}  // namespace patchmill
