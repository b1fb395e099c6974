#include "core/base/instruction_set.h"

#include <gtest/gtest.h>

#include "tests/support/instruction_sets.h"

namespace patchmill {
namespace {

TEST(InstructionSets, FastestIsUsedAndPlainIsAlwaysThere) {
  const std::vector<InstructionSet> sets = InstructionSets();
  EXPECT_EQ(UsedInstructionSet(), sets.front());
  EXPECT_EQ(sets.back(), InstructionSet::kPlain);
  for (std::size_t k = 1; k < sets.size(); ++k) EXPECT_GT(sets[k - 1], sets[k]);
}

TEST(InstructionSets, OthersCanBeUsed) {
  for (const InstructionSet set : InstructionSets()) {
    const testing::OnInstructionSet on(set);
    EXPECT_EQ(UsedInstructionSet(), set) << Name(set);
  }
  EXPECT_EQ(UsedInstructionSet(), InstructionSets().front());
}

}  // namespace
}  // namespace patchmill
