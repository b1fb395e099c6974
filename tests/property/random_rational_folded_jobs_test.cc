// Jobs over random rational and folded parts keep the promises [verification, section 1].
#include "tests/property/random_job.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

class RandomRationalFoldedJobs : public ::testing::TestWithParam<int> {};

TEST_P(RandomRationalFoldedJobs, KeepThePromises) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  ExpectPromisesKept(DrawJob(seed, /*folds=*/true, /*rational=*/true), seed);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomRationalFoldedJobs, JobSeeds(4000, kSanitized ? 2 : CountOf(6, 10)));
// A level beside a flat maximum: contacts known loosely had its chords divided without end.
INSTANTIATE_TEST_SUITE_P(LooseContacts, RandomRationalFoldedJobs, ::testing::Values(4110));
// Folds within microns of each other: tens of thousands of items for every stretch of an edge.
INSTANTIATE_TEST_SUITE_P(CloseFolds, RandomRationalFoldedJobs, ::testing::Values(4137));

}  // namespace
}  // namespace patchmill
