// How long a computation continues after a cancel.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include <absl/status/status.h>
#include <pthread.h>

#include "core/base/run_context.h"
#include "core/base/vec.h"
#include "tests/support/clock.h"

namespace patchmill::testing {

struct CancelLatency {
  absl::Status status;   // what the work ended with
  double seconds = 0.0;  // of its processor time, from the cancel to the end; 0 when it was done before
};

// Runs `work` on one thread and cancels it from another after `after` seconds of processor time. Processor
// time is used instead of wall clock, so that a busy machine does not change the result.
inline CancelLatency CancelAfter(double after, const std::function<absl::Status(const RunContext&)>& work) {
  clockid_t clock{};
  pthread_getcpuclockid(pthread_self(), &clock);
  const double start = ClockSeconds(clock);
  RunContext run(1);
  std::atomic<bool> done{false};
  double asked = kInfinity;
  std::thread canceller([&] {
    while (!done) {
      const double now = ClockSeconds(clock);
      if (now >= start + after) {
        run.Cancel();
        asked = now;
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  CancelLatency result;
  result.status = work(run);
  const double end = ClockSeconds(clock);
  done = true;
  canceller.join();
  if (asked < end) result.seconds = end - asked;
  return result;
}

}  // namespace patchmill::testing
