#include "server/call.h"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/limits.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using ::testing::_;
using ::testing::HasSubstr;
using testing::StatusIs;
using Clock = std::chrono::steady_clock;

// Work that ends only after a cancel.
absl::Status Endless(const RunContext& run) {
  while (run.Check().ok()) std::this_thread::sleep_for(1ms);
  return run.Check();
}

class RunJobThreadTest : public ::testing::Test {
 protected:
  Call MakeCall() {
    Call call;
    call.env = &env_;
    return call;
  }
  ServerEnv env_{ServerOptions{}};
};

TEST_F(RunJobThreadTest, ReturnsWhatTheWorkReturns) {
  EXPECT_TRUE(RunJobThread(MakeCall(), 0, {}, [](const RunContext&) { return absl::OkStatus(); }).ok());
  EXPECT_THAT(RunJobThread(MakeCall(), 0, {}, [](const RunContext&) { return absl::InternalError("x"); }),
              StatusIs(absl::StatusCode::kInternal, "x"));
}

TEST_F(RunJobThreadTest, ObeysACancelWithin200Milliseconds) {
  std::atomic<bool> cancelled{false};
  Call call = MakeCall();
  call.cancelled = [&] { return cancelled.load(); };
  auto best = std::chrono::nanoseconds::max();
  for (int attempt = 0; attempt < 3; ++attempt) {
    cancelled = false;
    Clock::time_point at;
    std::thread canceller([&] {
      std::this_thread::sleep_for(120ms);
      at = Clock::now();
      cancelled = true;
    });
    EXPECT_THAT(RunJobThread(call, 0, {}, Endless), StatusIs(absl::StatusCode::kCancelled, _));
    const auto end = Clock::now();
    canceller.join();
    best = std::min(best, std::chrono::nanoseconds(end - at));
  }
  EXPECT_LT(best, 200ms);
}

TEST_F(RunJobThreadTest, ObeysTheCallersDeadlineAndTheServersLimit) {
  Call call = MakeCall();
  call.deadline = Clock::now() + 50ms;
  EXPECT_THAT(RunJobThread(call, 0, {}, Endless), StatusIs(absl::StatusCode::kDeadlineExceeded, _));
  env_.options.max_job_seconds = 0.05;
  call.deadline.reset();
  EXPECT_THAT(RunJobThread(call, 0, {}, Endless), StatusIs(absl::StatusCode::kDeadlineExceeded, _));
}

TEST_F(RunJobThreadTest, BeatsAtLeastTwiceASecondThoughNothingProgresses) {
  std::vector<Clock::time_point> beats = {Clock::now()};
  std::string stage;
  const Beat beat = [&](std::string_view s, double) {
    beats.push_back(Clock::now());
    stage = s;
    return true;
  };
  ASSERT_TRUE(RunJobThread(MakeCall(), 0, beat, [](const RunContext& run) {
                run.Progress("dig", 0.5);
                std::this_thread::sleep_for(1100ms);
                return absl::OkStatus();
              }).ok());
  EXPECT_GE(beats.size(), 4u);
  for (std::size_t i = 1; i < beats.size(); ++i) EXPECT_LT(beats[i] - beats[i - 1], 500ms);
  EXPECT_EQ(stage, "dig");
}

TEST_F(RunJobThreadTest, StopsWhenTheOtherSideIsGone) {
  EXPECT_THAT(RunJobThread(
                  MakeCall(), 0, [](std::string_view, double) { return false; }, Endless),
              StatusIs(absl::StatusCode::kCancelled, _));
}

TEST_F(RunJobThreadTest, AnExceptionBecomesAStatus) {
  EXPECT_THAT(RunJobThread(MakeCall(), 0, {},
                           [](const RunContext&) -> absl::Status { throw std::runtime_error("odd"); }),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("odd")));
  EXPECT_THAT(
      RunJobThread(MakeCall(), 0, {}, [](const RunContext&) -> absl::Status { throw std::bad_alloc(); }),
      StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("memory")));
}

// Of the one that talks, while the other works: it stops the work, and goes its way.
TEST_F(RunJobThreadTest, AnExceptionOfTheBeatStopsTheWork) {
  const auto beat = [](std::string_view, double) -> bool { throw std::runtime_error("no memory"); };
  EXPECT_THROW((void)RunJobThread(MakeCall(), 0, beat, Endless), std::runtime_error);
}

TEST_F(RunJobThreadTest, ThreadsNeverExceedTheServers) {
  env_.options.threads = 2;
  const auto threads = [&](int asked) {
    int got = -1;
    EXPECT_TRUE(RunJobThread(MakeCall(), asked, {}, [&](const RunContext& run) {
                  got = run.threads();
                  return absl::OkStatus();
                }).ok());
    return got;
  };
  EXPECT_EQ(threads(0), 2);
  EXPECT_EQ(threads(1), 1);
  EXPECT_EQ(threads(64), 2);
}

TEST(CheckThreads, IsARange) {
  EXPECT_TRUE(CheckThreads(0, "max_threads").ok());
  EXPECT_TRUE(CheckThreads(limits::kMaxThreads, "max_threads").ok());
  EXPECT_THAT(CheckThreads(-1, "max_threads"),
              StatusIs(absl::StatusCode::kInvalidArgument, "max_threads = -1; must be in [0, 64]"));
  EXPECT_FALSE(CheckThreads(65, "max_threads").ok());
}

TEST(Admission, LetsInAsManyAsItMay) {
  Admission admission(2);
  auto first = admission.Enter();
  auto second = admission.Enter();
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_THAT(admission.Enter().status(),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("2 jobs")));
  { const auto leaving = *std::move(first); }
  EXPECT_TRUE(admission.Enter().ok());
  EXPECT_EQ(admission.running(), 1);
  admission.Drain();
  EXPECT_THAT(admission.Enter().status(), StatusIs(absl::StatusCode::kUnavailable, _));
}

}  // namespace
}  // namespace patchmill
