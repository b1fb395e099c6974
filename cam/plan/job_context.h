// What all stages of planning read and none changes.
#pragma once

#include "cam/location/limits/operation_limits.h"
#include "cam/plan/job.h"
#include "cam/plan/resolve.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// References to values that outlive every stage. A stage takes this and the values of the stages before it,
// and returns a value of its own.
struct JobContext {
  const Surface& surface;
  const Job& job;
  const Resolved& resolved;
  const OperationLimits& limits;  // what the operation selects and where it allows the centre
  const RunContext& run;
};

}  // namespace patchmill
