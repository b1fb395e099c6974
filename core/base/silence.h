// When progress is told again: not for every item of fast work, and not too late for slow work.
#pragma once

#include <atomic>
#include <chrono>

#include "core/base/run_context.h"

namespace patchmill {

// Since a stage's last word, for any number of threads. A look at the clock, some 30 ns.
class Silence {
 public:
  // A tenth of a second without a word: told at twice the rate that a client may count on (0.2 s).
  bool TooLong() const { return Now() - told_.load(std::memory_order_relaxed) > kLongest; }
  void Break() { told_.store(Now(), std::memory_order_relaxed); }
  // Tells run.Progress(stage, done/all) when it has been too long.
  void BreakIfTooLong(const RunContext& run, const char* stage, std::size_t done, std::size_t all) {
    if (!TooLong()) return;
    Break();
    run.Progress(stage, static_cast<double>(done) / static_cast<double>(all));
  }

 private:
  using Duration = RunContext::Clock::duration;
  static constexpr std::chrono::milliseconds kLongest{100};
  static Duration Now() { return RunContext::Clock::now().time_since_epoch(); }
  std::atomic<Duration> told_{Now()};
};

}  // namespace patchmill
