// Processor time: what a busy machine does not spoil.
#pragma once

#include <time.h>

namespace patchmill::testing {

// Of a clock such as CLOCK_THREAD_CPUTIME_ID.
inline double ClockSeconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace patchmill::testing
