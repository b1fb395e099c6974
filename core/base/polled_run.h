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
  explicit PolledRun(const RunContext& run) : before_(current_) { current_ = &run; }
  ~PolledRun() { current_ = before_; }
  PolledRun(const PolledRun&) = delete;
  PolledRun& operator=(const PolledRun&) = delete;

  // The run of the innermost PolledRun on this thread; null outside of any.
  static const RunContext* current() { return current_; }

 private:
  static inline thread_local const RunContext* current_ = nullptr;
  const RunContext* before_;
};

// True if the work of this thread is cancelled or its deadline has passed.
inline bool ThisThreadCancelled() {
  const RunContext* run = PolledRun::current();
  return run != nullptr && run->Cancelled();
}

}  // namespace patchmill
