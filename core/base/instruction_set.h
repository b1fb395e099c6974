// Which vector instructions run the code that is compiled for several of them. Every choice gives the same
// bits ([verification P5]) and differs in speed only.
#pragma once

#include <atomic>
#include <vector>

// Defined where the build holds code for instructions that not every processor of the kind has. This is GCC
// only: other compilers do not compile functions for another instruction set from the same pragma.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define PATCHMILL_X86_VECTORS 1
#endif

namespace patchmill {

// kPlain: what every processor of its kind has, two doubles at a time (SSE2, NEON). kAvx512: F and DQ.
enum class InstructionSet { kPlain, kAvx2, kAvx512 };
const char* Name(InstructionSet set);  // "plain", "avx2", "avx512"

// The sets that this processor can run and the build has code for, fastest first. kPlain is always the last.
std::vector<InstructionSet> InstructionSets();

namespace internal {
extern std::atomic<InstructionSet> used_instruction_set;
}

// The set that all code runs on: the fastest one, unless UseInstructionSet says otherwise.
inline InstructionSet UsedInstructionSet() {
  return internal::used_instruction_set.load(std::memory_order_relaxed);
}

// Takes one of InstructionSets() for the whole process, from the next query on. It serves tests, measurements
// and the search for faults.
void UseInstructionSet(InstructionSet set);

}  // namespace patchmill
