#include "core/base/run_context.h"

#include <thread>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

using namespace std::chrono_literals;

TEST(RunContext, EndsAtItsDeadlineAndNotBefore) {
  for (int k = 0; k < 5; ++k) {
    RunContext run;
    const auto deadline = RunContext::Clock::now() + 30ms;
    run.set_deadline(deadline);
    while (!run.Cancelled()) {
      ASSERT_LT(RunContext::Clock::now(), deadline + 5s);
    }
    EXPECT_GE(RunContext::Clock::now(), deadline);
    EXPECT_EQ(run.Check().code(), absl::StatusCode::kDeadlineExceeded);
  }
}

TEST(RunContext, NoticesADeadlineWithinTheTickOfTheCoarseClock) {
  RunContext run;
  run.set_deadline(RunContext::Clock::now());
  std::this_thread::sleep_for(20ms);
  EXPECT_TRUE(run.Cancelled());
}

TEST(RunContext, WithoutADeadlineOnlyACancelEndsIt) {
  RunContext run;
  EXPECT_FALSE(run.Cancelled());
  EXPECT_TRUE(run.Check().ok());
  run.Cancel();
  EXPECT_TRUE(run.Cancelled());
  EXPECT_EQ(run.Check().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
