#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

TEST(ParallelFor, CallsEveryIndexOnceForAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 7}) {
    SCOPED_TRACE(threads);
    std::vector<int> calls(1000, 0);
    EXPECT_TRUE(
        ParallelFor(RunContext(threads), nullptr, calls.size(), [&](std::size_t i) { ++calls[i]; }).ok());
    EXPECT_EQ(calls, std::vector<int>(1000, 1));
    // What one loop wrote the next may read.
    std::vector<int> sums(calls.size(), 0);
    EXPECT_TRUE(ParallelFor(RunContext(threads), nullptr, sums.size(), [&](std::size_t i) {
                  sums[i] = std::accumulate(calls.begin(), calls.begin() + static_cast<std::ptrdiff_t>(i), 0);
                }).ok());
    for (std::size_t i = 0; i < sums.size(); ++i) EXPECT_EQ(sums[i], static_cast<int>(i));
  }
  EXPECT_TRUE(ParallelFor(RunContext(), nullptr, 0, [](std::size_t) { ADD_FAILURE(); }).ok());
}

TEST(ParallelFor, LoopsNest) {
  std::vector<std::vector<int>> table(20, std::vector<int>(30, 0));
  const RunContext run(3);
  EXPECT_TRUE(ParallelFor(run, nullptr, table.size(), [&](std::size_t i) {
                EXPECT_TRUE(ParallelFor(run, nullptr, table[i].size(), [&](std::size_t k) {
                              table[i][k] += static_cast<int>(i * k);
                            }).ok());
              }).ok());
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t k = 0; k < table[i].size(); ++k) EXPECT_EQ(table[i][k], static_cast<int>(i * k));
  }
}

TEST(ParallelFor, StopsWhenCancelledByAnyCall) {
  for (const int threads : {1, 4}) {
    SCOPED_TRACE(threads);
    RunContext run(threads);
    std::atomic<int> calls{0};
    const absl::Status status = ParallelFor(run, nullptr, 100000, [&](std::size_t) {
      if (++calls == 10) run.Cancel();
    });
    EXPECT_EQ(status.code(), absl::StatusCode::kCancelled);
    EXPECT_GE(calls.load(), 10);
    EXPECT_LE(calls.load(), 10 + threads);  // each other thread may be in one call, past its look at the flag
  }
}

TEST(ParallelFor, ReportsProgressUpToTheEnd) {
  RunContext run(2);
  std::mutex mutex;
  std::vector<double> fractions;
  run.set_progress([&](std::string_view stage, double fraction) {
    const std::lock_guard<std::mutex> lock(mutex);
    EXPECT_EQ(stage, "work");
    fractions.push_back(fraction);
  });
  EXPECT_TRUE(ParallelFor(run, "work", 640, [](std::size_t) {}).ok());
  ASSERT_EQ(fractions.size(), 64u);
  std::sort(fractions.begin(), fractions.end());
  for (std::size_t i = 0; i < fractions.size(); ++i)
    EXPECT_EQ(fractions[i], static_cast<double>(i + 1) / 64.0);
}

}  // namespace
}  // namespace patchmill
