// Jobs over random smooth parts keep the promises [verification, section 1].
#include "tests/property/random_job.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

class RandomSmoothJobs : public ::testing::TestWithParam<int> {};

TEST_P(RandomSmoothJobs, KeepThePromises) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  ExpectPromisesKept(DrawJob(seed, /*folds=*/false, /*rational=*/false), seed);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomSmoothJobs, JobSeeds(1000, kSanitized ? 3 : CountOf(12, 24)));

}  // namespace
}  // namespace patchmill
