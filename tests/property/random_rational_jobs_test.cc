// Jobs over random rational parts keep the promises [verification, section 1].
#include "tests/property/random_job.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

class RandomRationalJobs : public ::testing::TestWithParam<int> {};

TEST_P(RandomRationalJobs, KeepThePromises) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  ExpectPromisesKept(DrawJob(seed, /*folds=*/false, /*rational=*/true), seed);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomRationalJobs, JobSeeds(3000, kSanitized ? 3 : CountOf(12, 24)));

}  // namespace
}  // namespace patchmill
