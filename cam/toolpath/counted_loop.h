// The parallel loop in which passes are made: it counts them and ends where they pass a limit.
#pragma once

#include <cstddef>
#include <functional>

#include <absl/status/status.h>

#include "cam/toolpath/path_amount.h"
#include "core/base/run_context.h"

namespace patchmill {

// ParallelFor whose body tells how much it has made. CheckAmount's error once that and budget.made pass
// budget.limits: the same one for any number of threads, and soon after. The limit is passed by as much as
// one look allows at most: 64 calls at first, later as many as reach it at the length of the longest call so
// far, or as there were before, whichever is fewer. `stage` names the work in progress and error.
absl::Status CountedFor(const RunContext& run, const char* stage, std::size_t count, const PathBudget& budget,
                        const std::function<PathAmount(std::size_t)>& body);

}  // namespace patchmill
