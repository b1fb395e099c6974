// Jobs with a forced strategy over random parts keep the promises [verification, section 1] in the area that
// the strategy can finish.
#include "tests/property/random_job.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

class RandomForcedJobs : public ::testing::TestWithParam<int> {};

TEST_P(RandomForcedJobs, KeepThePromises) {
  const int k = GetParam();
  const auto seed = static_cast<std::uint64_t>(k);
  for (const Strategy strategy : {Strategy::kContour, Strategy::kZigzag}) {
    RandomJob drawn = DrawJob(seed, /*folds=*/k % 5 == 4, /*rational=*/k % 2 == 1);
    drawn.job.operation.strategy = strategy;
    drawn.text += strategy == Strategy::kContour ? ", contours only" : ", lines only";
    ExpectPromisesKept(drawn, seed);
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomForcedJobs, JobSeeds(5000, kSanitized ? 2 : 5));

}  // namespace
}  // namespace patchmill
