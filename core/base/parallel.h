// Parallel loops whose results do not depend on the number of threads: only the call with i writes slot i.
#pragma once

#include <cstddef>
#include <functional>

#include <absl/status/status.h>

#include "core/base/run_context.h"

namespace patchmill {

// Calls body(i) for i in [0,count) on up to run.threads() threads. When cancelled, it stops early and returns
// that status; otherwise OK. `body` must not throw. Reports run.Progress(stage, done/count) if `stage` is not
// null.
absl::Status ParallelFor(const RunContext& run, const char* stage, std::size_t count,
                         const std::function<void(std::size_t)>& body);

// Runs the calls [first,last) of a loop over [0,count). Progress is that of the whole loop.
struct LoopPart {
  std::size_t first = 0, last = 0, count = 0;
};
absl::Status ParallelFor(const RunContext& run, const char* stage, const LoopPart& part,
                         const std::function<void(std::size_t)>& body);

}  // namespace patchmill
