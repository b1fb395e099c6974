// Jobs over random folded parts keep the promises [verification, section 1].
#include "tests/property/random_job.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

class RandomFoldedJobs : public ::testing::TestWithParam<int> {};

TEST_P(RandomFoldedJobs, KeepThePromises) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  ExpectPromisesKept(DrawJob(seed, /*folds=*/true, /*rational=*/false), seed);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomFoldedJobs, JobSeeds(2000, kSanitized ? 2 : CountOf(6, 10)));
// Spots of a wall that the wall beside it blocks. Raising the centre away from both leaves more than moving
// it sideways.
INSTANTIATE_TEST_SUITE_P(BesideWalls, RandomFoldedJobs, ::testing::Values(2116));

}  // namespace
}  // namespace patchmill
