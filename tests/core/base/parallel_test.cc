#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/share_progress.h"

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

TEST(ParallelFor, APartOfALoopTellsTheProgressOfTheWhole) {
  for (const int threads : {1, 3}) {
    std::vector<int> calls(100, 0);
    RunContext run(threads);
    std::mutex mutex;
    double furthest = 0.0;
    run.set_progress([&](std::string_view, double fraction) {
      const std::lock_guard<std::mutex> lock(mutex);
      furthest = std::max(furthest, fraction);
    });
    const auto part = [&](std::size_t first, std::size_t last) {
      EXPECT_TRUE(
          ParallelFor(run, "loop", LoopPart{first, last, 100}, [&](std::size_t i) { ++calls[i]; }).ok());
    };
    part(0, 50);
    EXPECT_EQ(furthest, 0.5);
    EXPECT_EQ(std::accumulate(calls.begin(), calls.begin() + 50, 0), 50);
    part(50, 50);
    part(50, 100);
    EXPECT_EQ(furthest, 1.0);
    EXPECT_EQ(calls, std::vector<int>(100, 1));
  }
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
  // And maybe after a silence, on a busy machine.
  for (int i = 1; i <= 64; ++i) EXPECT_EQ(std::count(fractions.begin(), fractions.end(), i / 64.0), 1) << i;
}

// Long before a sixty-fourth of it is done.
template <typename Work>
int TimesToldOfSlowWork(const Work& work) {
  RunContext run(1);
  int reports = 0;
  run.set_progress([&](std::string_view, double fraction) {
    ++reports;
    EXPECT_LT(fraction, 1.0 / 64.0);
  });
  work(run, [] { std::this_thread::sleep_for(std::chrono::milliseconds(30)); });
  return reports;
}

TEST(ParallelFor, TellsSlowWorkBeforeSilenceIsTooLong) {
  EXPECT_GE(TimesToldOfSlowWork([](RunContext& run, const auto& wait) {
              EXPECT_FALSE(ParallelFor(run, "work", 100000, [&](std::size_t i) {
                             wait();
                             if (i == 12) run.Cancel();
                           }).ok());
            }),
            2);
}

TEST(ShareProgress, TellsSlowWorkBeforeSilenceIsTooLong) {
  EXPECT_GE(TimesToldOfSlowWork([](RunContext& run, const auto& wait) {
              ShareProgress progress(run, "work", 1);
              for (int i = 0; i < 12; ++i) {
                wait();
                progress.Add(20);
              }
            }),
            2);
}

}  // namespace
}  // namespace patchmill
