// The same request gives the same bytes, whatever the processor can do (P5).
#include "tests/support/instruction_sets.h"

#include "tests/property/random_job.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

void ExpectSameBytes(const PatchModel& model, const Job& job) {
  const auto mill = [&](InstructionSet set) {
    const OnInstructionSet on(set);
    return Mill(PlacedSurface(model), job);
  };
  const JobResult plain = mill(InstructionSet::kPlain);
  ASSERT_FALSE(plain.program.empty()) << Describe(plain);
  for (const InstructionSet set : InstructionSets()) {
    if (set == InstructionSet::kPlain) continue;
    const JobResult other = mill(set);
    EXPECT_TRUE(plain.program == other.program) << Name(set) << ": another program";
    EXPECT_EQ(Describe(plain), Describe(other)) << Name(set);
    EXPECT_EQ(plain.report.regions.size(), other.report.regions.size()) << Name(set);
  }
}

TEST(InstructionSets, DoNotChangeTheProgramOfRandomParts) {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 1 : 3); ++seed) {
    const RandomJob drawn = DrawJob(700 + seed, /*folds=*/seed == 1, /*rational=*/seed == 2);
    SCOPED_TRACE(drawn.text);
    ExpectSameBytes(drawn.model, drawn.job);
  }
}

TEST(InstructionSets, DoNotChangeTheProgramOfManyPatches) {
  Job job = BallJob(2.0);
  job.operation.scallop = 0.05;
  ExpectSameBytes(Torus({0, 0, 0}, 9, 4, Half::kUpper), job);
}

}  // namespace
}  // namespace patchmill
