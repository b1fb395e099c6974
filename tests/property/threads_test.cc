// The same request gives the same bytes, whatever the number of threads (P5).
#include "tests/property/random_job.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

void ExpectSameBytes(const PatchModel& model, const Job& job) {
  const JobResult one = Mill(PlacedSurface(model), job, 1);
  ASSERT_FALSE(one.program.empty()) << Describe(one);
  for (const int threads : {2, 5}) {
    const JobResult other = Mill(PlacedSurface(model), job, threads);
    EXPECT_TRUE(one.program == other.program) << threads << " threads: another program";
    EXPECT_EQ(Describe(one), Describe(other));
    ASSERT_EQ(one.report.regions.size(), other.report.regions.size());
    for (std::size_t i = 0; i < one.report.regions.size(); ++i) {
      EXPECT_EQ(one.report.regions[i].area, other.report.regions[i].area) << "region " << i;
      EXPECT_EQ(one.report.regions[i].inside, other.report.regions[i].inside) << "region " << i;
    }
  }
}

TEST(Threads, DoNotChangeTheProgramOfRandomParts) {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 1 : 3); ++seed) {
    const RandomJob drawn = DrawJob(500 + seed, /*folds=*/seed == 1, /*rational=*/seed == 2);
    SCOPED_TRACE(drawn.text);
    ExpectSameBytes(drawn.model, drawn.job);
  }
}

TEST(Threads, DoNotChangeTheProgramOfManyPatches) {
  Job job = BallJob(2.0);
  job.operation.scallop = 0.05;
  ExpectSameBytes(Torus({0, 0, 0}, 9, 4, Half::kUpper), job);
}

}  // namespace
}  // namespace patchmill
