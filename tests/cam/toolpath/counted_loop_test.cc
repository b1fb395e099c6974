#include "cam/toolpath/counted_loop.h"

#include <atomic>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error_details.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kCalls = 5000;

// Calls of a lens-shaped part: lines begin short, grow and get short again.
double LengthOf(std::size_t i) { return 1.0 + 100.0 * std::sin(kPi * static_cast<double>(i) / kCalls); }

double Sum(std::size_t calls) {
  double sum = 0.0;
  for (std::size_t i = 0; i < calls; ++i) sum += LengthOf(i);
  return sum;
}

struct Counted {
  absl::Status status;
  double made = 0.0;
  std::size_t calls = 0;
};

Counted Count(const PathBudget& budget, int threads, std::size_t count = kCalls) {
  Counted counted;
  std::atomic<double> made{0.0};
  std::atomic<std::size_t> calls{0};
  counted.status = CountedFor(RunContext(threads), "lines", count, budget, [&](std::size_t i) {
    made.fetch_add(LengthOf(i));
    ++calls;
    return PathAmount{LengthOf(i), 3.0};
  });
  counted.made = made;
  counted.calls = calls;
  return counted;
}

TEST(CountedFor, MakesEverythingThatTheLimitsLet) {
  const double all = Sum(kCalls);
  for (const int threads : {1, 4}) {
    for (const PathLimits& limits : {PathLimits{}, PathLimits{1.000001 * all, 3.0 * kCalls}}) {
      const Counted counted = Count({limits, {}}, threads);
      EXPECT_TRUE(counted.status.ok()) << counted.status;
      EXPECT_EQ(counted.calls, kCalls);
    }
    EXPECT_TRUE(Count({{0.5 * all, kInfinity}, {}}, threads, 0).status.ok());
  }
}

// Soon after the limit, and with the same words for any number of threads.
TEST(CountedFor, EndsSoonAfterALimitIsPassed) {
  const double all = Sum(kCalls);
  for (const double share : {0.01, 0.1, 0.5, 0.9, 0.9999}) {
    const PathBudget budget{{share * all, kInfinity}, {}};
    const Counted one = Count(budget, 1);
    const std::optional<PassedLimit> passed = LimitPassedOf(one.status);
    ASSERT_TRUE(passed.has_value()) << one.status;
    EXPECT_EQ(passed->name, "cut_length_mm");
    EXPECT_EQ(passed->limit, share * all);
    EXPECT_NEAR(passed->value, one.made, 1e-9 * all);
    EXPECT_GT(passed->value, passed->limit);
    EXPECT_LT(passed->value, 1.5 * passed->limit + Sum(64)) << share;
    EXPECT_THAT(std::string(one.status.message()), HasSubstr("% of the stage \"lines\""));
    for (const int threads : {2, 5}) EXPECT_EQ(Count(budget, threads).status, one.status);
  }
}

TEST(CountedFor, WhatWasMadeBeforeCounts) {
  const PathBudget budget{{kInfinity, 3.0 * kCalls}, {0.0, 1.0}};
  const Counted counted = Count(budget, 2);
  const std::optional<PassedLimit> passed = LimitPassedOf(counted.status);
  ASSERT_TRUE(passed.has_value()) << counted.status;
  EXPECT_EQ(passed->name, "point_count");
  EXPECT_EQ(passed->value, 3.0 * kCalls + 1.0);
  EXPECT_TRUE(Count({budget.limits, {}}, 2).status.ok());
}

TEST(CountedFor, ACancelIsNoLimit) {
  RunContext run(2);
  run.Cancel();
  const absl::Status status = CountedFor(run, "lines", kCalls, {{1.0, 1.0}, {}}, [](std::size_t) {
    return PathAmount{10.0, 10.0};
  });
  EXPECT_EQ(status.code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
