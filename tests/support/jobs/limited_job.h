// Jobs with limits, for tests of what they leave.
#pragma once

#include "tests/support/jobs/jobs.h"

namespace patchmill::testing {

inline constexpr double kLimitedRadius = 3.0;  // mm, of LimitedJob's ball

inline Job LimitedJob() {
  Job job = BallJob(kLimitedRadius);
  job.operation.scallop = 0.02;
  return job;
}

inline Ring RingOfBox(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

}  // namespace patchmill::testing
