#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace patchmill {

absl::Status ParallelFor(const RunContext& run, const char* stage, std::size_t count,
                         const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> done{0};
  const std::size_t report_every = std::max<std::size_t>(1, count / 64);
  const auto one = [&](std::size_t i) {
    if (run.Cancelled()) return;
    body(i);
    const std::size_t n = done.fetch_add(1, std::memory_order_relaxed) + 1;
    if (stage != nullptr && (n % report_every == 0 || n == count)) {
      run.Progress(stage, static_cast<double>(n) / static_cast<double>(count));
    }
  };
  if (run.threads() == 1) {
    for (std::size_t i = 0; i < count && !run.Cancelled(); ++i) one(i);
  } else {
    tbb::task_arena arena(run.threads() > 0 ? run.threads() : tbb::task_arena::automatic);
    arena.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1),
                        [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i != range.end(); ++i) one(i);
                        });
    });
  }
  return run.Check();
}

}  // namespace patchmill
