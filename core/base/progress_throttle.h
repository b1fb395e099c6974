// When progress is told again: not for every item of fast work, and not too late for slow work.
#pragma once

#include <atomic>
#include <chrono>

#include "core/base/run_context.h"

namespace patchmill {

// Since a stage's last word, for any number of threads. A look at the clock, some 30 ns.
class ProgressThrottle {
 public:
  // A tenth of a second without a word: told at twice the rate that a client may count on (0.2 s).
  bool Due() const { return Now() - reported_.load(std::memory_order_relaxed) > kInterval; }
  void Report() { reported_.store(Now(), std::memory_order_relaxed); }
  // Tells run.Progress(stage, done/all) when it has been too long.
  void ReportIfDue(const RunContext& run, const char* stage, std::size_t done, std::size_t all) {
    if (!Due()) return;
    Report();
    run.Progress(stage, static_cast<double>(done) / static_cast<double>(all));
  }

 private:
  using Duration = RunContext::Clock::duration;
  static constexpr std::chrono::milliseconds kInterval{100};
  static Duration Now() { return RunContext::Clock::now().time_since_epoch(); }
  std::atomic<Duration> reported_{Now()};
};

}  // namespace patchmill
