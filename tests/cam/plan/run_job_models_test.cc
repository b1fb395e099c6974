// A program for every model at hand: verified, and judged again by plain distances. Networks:
// tests/jobs/tests.cmake.
#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/model_table.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

class ModelsAtHand : public ::testing::TestWithParam<int> {};

TEST_P(ModelsAtHand, AreMilledAsPromised) {
  const TableRow row = ModelTable()[static_cast<std::size_t>(GetParam())];
  SCOPED_TRACE(row.file);
  if (IsNetwork(row)) GTEST_SKIP() << "a network";
  const auto model = ModelOf(row);
  if (!model) GTEST_SKIP() << row.file << " is not here";
  Job job = BallJob(3.0, /*deep=*/false);
  job.operation.scallop = 0.03;
  job.operation.tolerance = 0.02;
  const Surface surface = PlacedSurface(*model);
  const JobResult result = Mill(surface, job);
  Random random(static_cast<std::uint64_t>(GetParam()));
  CheckProgram(surface, job, result, random, 500);
  EXPECT_EQ(result.report.certificate_defects, 0u) << Describe(result);
}

INSTANTIATE_TEST_SUITE_P(Table, ModelsAtHand,
                         ::testing::Range(0, kSanitized ? 4 : static_cast<int>(ModelTable().size())));

}  // namespace
}  // namespace patchmill
