// Progress and cancel as one small handle that is passed down to every long computation.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string_view>

#include <absl/status/status.h>
#include <time.h>

#include "core/base/memory_budget.h"

namespace patchmill {

// All threads of one job share it. It is cheap to poll: Cancelled() is one relaxed load and, only if a
// deadline is set, a read of the kernel's coarse clock, which is at most 10 ms late and never early.
class RunContext {
 public:
  using Clock = std::chrono::steady_clock;
  // Arguments: the stage, and the fraction in [0,1] of that stage that is done. The working thread calls it,
  // so it must be quick and thread-safe.
  using ProgressSink = std::function<void(std::string_view stage, double fraction)>;

  RunContext() = default;
  explicit RunContext(int threads) : threads_(threads) {}

  // 0: as many as the machine has. Results never depend on the number ([verification P5]).
  int threads() const { return threads_; }
  void set_threads(int threads) { threads_ = threads; }
  void set_progress(ProgressSink sink) { sink_ = std::move(sink); }
  void set_deadline(Clock::time_point deadline) {
    deadline_ = deadline;
    has_deadline_ = true;
  }

  void Cancel() { cancelled_.store(true, std::memory_order_relaxed); }  // any thread, any number of times
  bool Cancelled() const {
    return cancelled_.load(std::memory_order_relaxed) || (budget_ != nullptr && budget_->Exceeded()) ||
           DeadlinePassed();
  }
  // The job ends when it has taken more memory than `budget` grants; null: it may take any. `budget` outlives
  // the run.
  void set_budget(MemoryBudget* budget) { budget_ = budget; }
  MemoryBudget* budget() const { return budget_; }
  // OK, CANCELLED, DEADLINE_EXCEEDED, or RESOURCE_EXHAUSTED for the memory of the job.
  absl::Status Check() const;
  void Progress(std::string_view stage, double fraction) const {
    if (sink_) sink_(stage, fraction);
  }

 private:
  // Jobs poll so often that the exact clock takes 1.3 % of a job with a deadline.
  bool DeadlinePassed() const {
    if (!has_deadline_) return false;
    timespec now;  // of the clock that Clock reads, as of the kernel's last tick
    if (clock_gettime(CLOCK_MONOTONIC_COARSE, &now) != 0) return Clock::now() >= deadline_;
    return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec) >=
           deadline_.time_since_epoch();
  }

  int threads_ = 0;
  std::atomic<bool> cancelled_{false};
  bool has_deadline_ = false;
  Clock::time_point deadline_{};
  MemoryBudget* budget_ = nullptr;
  ProgressSink sink_;
};

}  // namespace patchmill
