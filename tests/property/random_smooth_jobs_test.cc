// Jobs over random smooth parts keep the promises of DESIGN 2.
#include "tests/property/random_job.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

class RandomSmoothJobs : public ::testing::TestWithParam<int> {};

TEST_P(RandomSmoothJobs, KeepThePromises) {
  const auto seed = static_cast<std::uint64_t>(1000 + GetParam());
  ExpectPromisesKept(DrawJob(seed, /*folds=*/false, /*rational=*/false), seed);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomSmoothJobs, ::testing::Range(0, kSanitized ? 3 : 38));

}  // namespace
}  // namespace patchmill
