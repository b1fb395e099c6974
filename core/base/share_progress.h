// Progress of work on a few large items that are halved again and again: the share of all work that is done.
#pragma once

#include <atomic>
#include <cstdint>

#include "core/base/progress_throttle.h"
#include "core/base/run_context.h"

namespace patchmill {

// Reports run.Progress(stage, share) about 64 times, and whenever ProgressThrottle is due. Any number of
// threads may call it; at most 2^23 items. A part costs an atomic addition and a clock read, 40 ns.
class ShareProgress {
 public:
  ShareProgress(const RunContext& run, const char* stage, std::size_t items)
      : run_(run), stage_(stage), all_(static_cast<std::uint64_t>(items) << kHalvings) {}

  // Counts 2^-halvings of an item as done; halvings in [0, 40].
  void Add(int halvings) {
    const std::uint64_t part = std::uint64_t{1} << (kHalvings - halvings);
    const std::uint64_t done = done_.fetch_add(part, std::memory_order_relaxed) + part;
    const std::uint64_t step = all_ / 64 + 1;
    if (done / step == (done - part) / step && done != all_ && !throttle_.Due()) return;
    throttle_.Report();
    run_.Progress(stage_, static_cast<double>(done) / static_cast<double>(all_));
  }

 private:
  static constexpr int kHalvings = 40;
  const RunContext& run_;
  const char* stage_;
  const std::uint64_t all_;
  std::atomic<std::uint64_t> done_{0};
  ProgressThrottle throttle_;
};

}  // namespace patchmill
