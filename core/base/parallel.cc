#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "core/base/polled_run.h"
#include "core/base/progress_throttle.h"

namespace patchmill {
namespace {

// ThreadSanitizer does not see how the packaged TBB passes work between threads and would report every
// passing as a race. Plain threads do the same work there.
#if defined(__SANITIZE_THREAD__)
void InParallel(int threads, std::size_t count, const std::function<void(std::size_t)>& one) {
  const std::size_t most =
      threads > 0 ? static_cast<std::size_t>(threads) : std::thread::hardware_concurrency();
  std::atomic<std::size_t> next{0};
  std::vector<std::jthread> workers;
  for (std::size_t k = 0; k < std::min(most, count); ++k) {
    workers.emplace_back([&] {
      for (std::size_t i = next.fetch_add(1); i < count; i = next.fetch_add(1)) one(i);
    });
  }
}
#else
void InParallel(int threads, std::size_t count, const std::function<void(std::size_t)>& one) {
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) one(i);
                      });
  });
}
#endif

}  // namespace

absl::Status ParallelFor(const RunContext& run, const char* stage, std::size_t count,
                         const std::function<void(std::size_t)>& body) {
  return ParallelFor(run, stage, {0, count, count}, body);
}

absl::Status ParallelFor(const RunContext& run, const char* stage, const LoopPart& part,
                         const std::function<void(std::size_t)>& body) {
  const std::size_t count = part.count;
  std::atomic<std::size_t> done{part.first};
  const std::size_t report_every = std::max<std::size_t>(1, count / 64);
  ProgressThrottle throttle;
  const auto one = [&](std::size_t i) {
    if (run.Cancelled()) return;
    const PolledRun polled(run);
    body(i);
    const std::size_t n = done.fetch_add(1, std::memory_order_relaxed) + 1;
    if (stage != nullptr && (n % report_every == 0 || n == count || throttle.Due())) {
      throttle.Report();
      run.Progress(stage, static_cast<double>(n) / static_cast<double>(count));
    }
  };
  if (run.threads() == 1) {
    for (std::size_t i = part.first; i < part.last && !run.Cancelled(); ++i) one(i);
  } else {
    InParallel(run.threads(), part.last - part.first, [&](std::size_t k) { one(part.first + k); });
  }
  return run.Check();
}

}  // namespace patchmill
