// Compares two jobs that must give the same bytes, and supplies the parts for it.
#pragma once

#include "tests/property/random_job.h"

namespace patchmill::testing {

inline void ExpectSameBytes(const JobResult& one, const JobResult& other) {
  ASSERT_FALSE(one.program.empty()) << Describe(one);
  EXPECT_TRUE(one.program == other.program) << "another program";
  EXPECT_EQ(Describe(one), Describe(other));
  ASSERT_EQ(one.report.regions.size(), other.report.regions.size());
  for (std::size_t i = 0; i < one.report.regions.size(); ++i) {
    EXPECT_EQ(one.report.regions[i].area, other.report.regions[i].area) << "region " << i;
    EXPECT_EQ(one.report.regions[i].inside, other.report.regions[i].inside) << "region " << i;
  }
}

// Smooth, folded and rational random parts, and one of many patches. `check` takes a model and a job.
template <class Check>
void OnSomeParts(std::uint64_t seed, const Check& check) {
  for (std::uint64_t k = 0; k < (kSanitized ? 1 : 3); ++k) {
    const RandomJob drawn = DrawJob(seed + k, /*folds=*/k == 1, /*rational=*/k == 2);
    SCOPED_TRACE(drawn.text);
    check(drawn.model, drawn.job);
  }
  Job job = BallJob(2.0);
  job.operation.scallop = 0.05;
  check(Torus({0, 0, 0}, 9, 4, Half::kUpper), job);
}

}  // namespace patchmill::testing
