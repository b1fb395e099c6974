#include "core/base/instruction_set.h"

#include <algorithm>

#include "core/base/status.h"

namespace patchmill {

const char* Name(InstructionSet set) {
  switch (set) {
    case InstructionSet::kPlain:
      return "plain";
    case InstructionSet::kAvx2:
      return "avx2";
    case InstructionSet::kAvx512:
      return "avx512";
  }
  return "unknown";
}

std::vector<InstructionSet> InstructionSets() {
  std::vector<InstructionSet> sets;
#ifdef PATCHMILL_X86_VECTORS
  if (__builtin_cpu_supports("avx2")) {
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
      sets.push_back(InstructionSet::kAvx512);
    sets.push_back(InstructionSet::kAvx2);
  }
#endif
  sets.push_back(InstructionSet::kPlain);
  return sets;
}

// The value is kPlain (zero) before it is initialised. Code that runs earlier gets the same bits.
std::atomic<InstructionSet> internal::used_instruction_set{InstructionSets().front()};

void UseInstructionSet(InstructionSet set) {
  const std::vector<InstructionSet> sets = InstructionSets();
  PM_CHECK(std::find(sets.begin(), sets.end(), set) != sets.end());
  internal::used_instruction_set.store(set, std::memory_order_relaxed);
}

}  // namespace patchmill
