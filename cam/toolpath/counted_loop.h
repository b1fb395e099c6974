// The parallel loop in which passes are made. It counts them and ends if they exceed a limit.
#pragma once

#include <cstddef>
#include <functional>

#include <absl/status/status.h>

#include "cam/toolpath/path_amount.h"
#include "core/base/run_context.h"

namespace patchmill {

// A ParallelFor whose body returns how much it has made. If the sum and budget.made exceed budget.limits, it
// returns CheckAmount's error soon after. The error is the same for any number of threads. Between two checks
// there are 64 calls at first. Later there are as many as before, or as many as would reach the limit at the
// length of the longest call so far, whichever is fewer, but at least 16. The limit can be exceeded by no
// more than these calls make. `stage` names the work in progress and in the error.
absl::Status CountedFor(const RunContext& run, const char* stage, std::size_t count, const PathBudget& budget,
                        const std::function<PathAmount(std::size_t)>& body);

}  // namespace patchmill
