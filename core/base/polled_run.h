// The run that a thread works for. A proof deep inside a query asks this run whether the result is still
// wanted.
#pragma once

#include "core/base/run_context.h"

namespace patchmill {

// A thread works for `run` from the constructor on until the destructor, and after that for the run before.
// ParallelFor makes a PolledRun for each body. RunJob and Verify make one for what they compute between their
// loops.
//
// A function that stops early because of ThisThreadCancelled() returns a result without meaning. So the maker
// of a PolledRun must call run.Check() before the result is used. A cancel is never taken back and a deadline
// never moves, so Check() fails then.
class PolledRun {
 public:
  explicit PolledRun(const RunContext& run) : before_(current_) {
    if (pending_ != 0) Settle();
    current_ = &run;
  }
  ~PolledRun() {
    if (pending_ != 0) Settle();
    current_ = before_;
  }
  PolledRun(const PolledRun&) = delete;
  PolledRun& operator=(const PolledRun&) = delete;

  // The run of the innermost PolledRun on this thread; null outside of any.
  static const RunContext* current() { return current_; }

  // Counts memory that this thread has taken (positive) or freed (negative) for its run. Small amounts are
  // added to the budget of the run together.
  static void CountMemory(std::int64_t bytes) {
    if (current_ == nullptr) return;
    pending_ += bytes;
    constexpr std::int64_t kTogether = 64 << 10;
    if (pending_ > kTogether || pending_ < -kTogether) Settle();
  }

 private:
  static void Settle() {
    const std::int64_t bytes = pending_;
    pending_ = 0;
    if (current_ != nullptr && current_->budget() != nullptr) current_->budget()->Add(bytes);
  }

  static inline thread_local const RunContext* current_ = nullptr;
  static inline thread_local std::int64_t pending_ = 0;
  const RunContext* before_;
};

// True if the work of this thread is cancelled or its deadline has passed.
inline bool ThisThreadCancelled() {
  const RunContext* run = PolledRun::current();
  return run != nullptr && run->Cancelled();
}

}  // namespace patchmill
