#include "core/base/resize_polling.h"

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

TEST(ResizePolling, IsAsResize) {
  std::vector<int> v(100), old(100);
  std::iota(v.begin(), v.end(), 1);
  old = v;
  for (const std::size_t size : {100, 101, 20'000, 100'000}) {
    EXPECT_TRUE(ResizePolling(v, size, RunContext()).ok());
    old.resize(size);
    EXPECT_EQ(v, old);
  }
}

TEST(ResizePolling, StopsBetweenSteps) {
  static RunContext cancelled;
  static int made = 0;
  struct Tells {
    Tells() {
      if (++made == 20'000) cancelled.Cancel();
    }
  };
  std::vector<Tells> v;
  EXPECT_EQ(ResizePolling(v, 100'000, cancelled).code(), absl::StatusCode::kCancelled);
  EXPECT_GE(v.size(), 20'000U);
  EXPECT_LT(v.size(), 50'000U);
}

}  // namespace
}  // namespace patchmill
