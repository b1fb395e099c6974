// What a row gains from the processor's vector instructions.
#pragma once

#include <functional>

#include <benchmark/benchmark.h>

namespace patchmill::bench {

// The row's label: the instruction set that everything runs on. `over_plain`: wall clock of `run` on the
// plain path, which every processor of its kind can run, over that on this one; `rounds` of each, in turn,
// the least of each. For the end of a row: what it runs is not part of the row's time.
void TellInstructionSet(benchmark::State& state, int rounds, const std::function<void()>& run);

}  // namespace patchmill::bench
