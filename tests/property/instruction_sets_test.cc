// The same request gives the same bytes, whatever the processor can do ([verification P5]).
#include "tests/support/instruction_sets.h"

#include "tests/property/same_bytes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

TEST(InstructionSets, DoNotChangeTheProgram) {
  OnSomeParts(700, [](const PatchModel& model, const Job& job) {
    const auto mill = [&](InstructionSet set) {
      const OnInstructionSet on(set);
      return Mill(PlacedSurface(model), job);
    };
    const JobResult plain = mill(InstructionSet::kPlain);
    for (const InstructionSet set : InstructionSets()) {
      if (set == InstructionSet::kPlain) continue;
      SCOPED_TRACE(Name(set));
      ExpectSameBytes(plain, mill(set));
    }
  });
}

}  // namespace
}  // namespace patchmill
