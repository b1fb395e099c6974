// The memory that one job may take.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

namespace patchmill {

// Counts the memory of one job in steps. All threads of the job share it. Only a program that replaces
// operator new (server/counted_new.cc) counts; elsewhere nothing is ever added.
class MemoryBudget {
 public:
  // Grants `bytes` beyond those before. False: there are no more. Called from any thread of the
  // job, one call at a time; it must not allocate memory through operator new.
  using Grant = std::function<bool(std::int64_t bytes)>;

  explicit MemoryBudget(std::int64_t granted = 0, Grant grant = {})
      : granted_(granted), grant_(std::move(grant)) {}
  MemoryBudget(const MemoryBudget&) = delete;
  MemoryBudget& operator=(const MemoryBudget&) = delete;

  // Adds memory that was taken (positive) or freed (negative).
  void Add(std::int64_t bytes) {
    const std::int64_t used = used_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
    if (used > granted_.load(std::memory_order_relaxed)) AskFor(used);
  }
  // Whether `bytes` more fit. Asks for them if they do not.
  bool Fits(std::int64_t bytes) {
    const std::int64_t used = used_.load(std::memory_order_relaxed) + bytes;
    if (used > granted_.load(std::memory_order_relaxed)) AskFor(used);
    return used <= granted_.load(std::memory_order_relaxed);
  }
  // The job has taken more than it was granted. Never taken back.
  bool Exceeded() const { return exceeded_.load(std::memory_order_relaxed); }
  std::int64_t used() const { return used_.load(std::memory_order_relaxed); }
  std::int64_t granted() const { return granted_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::int64_t kStep = 16 << 20;  // bytes that are requested at once, at least

  void AskFor(std::int64_t used) {
    while (asking_.test_and_set(std::memory_order_acquire)) {
    }
    const std::int64_t granted = granted_.load(std::memory_order_relaxed);
    if (used > granted) {
      const std::int64_t more = used - granted + kStep;
      if (grant_ && grant_(more)) {
        granted_.store(granted + more, std::memory_order_relaxed);
      } else {
        exceeded_.store(true, std::memory_order_relaxed);
      }
    }
    asking_.clear(std::memory_order_release);
  }

  std::atomic<std::int64_t> used_{0}, granted_;
  std::atomic<bool> exceeded_{false};
  std::atomic_flag asking_ = ATOMIC_FLAG_INIT;
  const Grant grant_;
};

}  // namespace patchmill
