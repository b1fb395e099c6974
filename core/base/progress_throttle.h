// Decides when progress is reported again: not for every item of fast work, and not too late for slow work.
#pragma once

#include <atomic>
#include <chrono>

#include "core/base/run_context.h"

namespace patchmill {

// Measures the time since the last report of a stage, for any number of threads. A call reads the clock,
// about 30 ns.
class ProgressThrottle {
 public:
  // True after 0.1 s without a report, half of the 0.2 s that a client may count on.
  bool Due() const { return Now() - reported_.load(std::memory_order_relaxed) > kInterval; }
  void Report() { reported_.store(Now(), std::memory_order_relaxed); }
  // Reports run.Progress(stage, done/all) if Due().
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
