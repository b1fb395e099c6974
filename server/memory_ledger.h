// The memory that calls may take together, beside their requests and answers (in_flight.h).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace patchmill {

class MemoryLedger {
 public:
  explicit MemoryLedger(std::int64_t limit_bytes) : limit_(limit_bytes) {}

  // Takes `bytes`, if they are there. Any thread; it allocates nothing.
  bool Take(std::int64_t bytes) {
    std::int64_t taken = taken_.load(std::memory_order_relaxed);
    do {
      if (taken + bytes > limit_) return false;
    } while (!taken_.compare_exchange_weak(taken, taken + bytes, std::memory_order_relaxed));
    return true;
  }
  void Release(std::int64_t bytes) { taken_.fetch_sub(bytes, std::memory_order_relaxed); }

  std::int64_t limit() const { return limit_; }
  std::int64_t taken() const { return taken_.load(std::memory_order_relaxed); }

 private:
  const std::int64_t limit_;
  std::atomic<std::int64_t> taken_{0};
};

}  // namespace patchmill
