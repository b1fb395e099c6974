// Building a locator obeys its RunContext.
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

TEST(Locator, CancelIsObeyedWithin200ms) {
  const Surface surface = testing::SurfaceOf(testing::Bumpy());
  RunContext run(2);
  std::chrono::steady_clock::time_point cancelled;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    cancelled = std::chrono::steady_clock::now();
    run.Cancel();
  });
  const auto locator = Locator::Make(surface, 0.4, run);
  const auto end = std::chrono::steady_clock::now();
  canceller.join();
  EXPECT_EQ(locator.status().code(), absl::StatusCode::kCancelled);
  EXPECT_LT(std::chrono::duration<double>(end - cancelled).count(), testing::kSanitized ? 3.0 : 0.2);
}

}  // namespace
}  // namespace patchmill
