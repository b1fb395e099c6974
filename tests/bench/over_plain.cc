#include "tests/bench/over_plain.h"

#include <algorithm>
#include <limits>

#include "tests/support/clock.h"
#include "tests/support/instruction_sets.h"

namespace patchmill::bench {
namespace {

double SecondsOn(InstructionSet set, const std::function<void()>& run) {
  const testing::OnInstructionSet on(set);
  const double start = testing::ClockSeconds(CLOCK_MONOTONIC);
  run();
  return testing::ClockSeconds(CLOCK_MONOTONIC) - start;
}

}  // namespace

void TellInstructionSet(benchmark::State& state, int rounds, const std::function<void()>& run) {
  const InstructionSet used = UsedInstructionSet();
  double plain = std::numeric_limits<double>::infinity(), fastest = plain;
  for (int round = 0; round < rounds; ++round) {
    plain = std::min(plain, SecondsOn(InstructionSet::kPlain, run));
    fastest = std::min(fastest, SecondsOn(used, run));
  }
  state.SetLabel(Name(used));
  state.counters["over_plain"] = plain / fastest;
}

}  // namespace patchmill::bench
