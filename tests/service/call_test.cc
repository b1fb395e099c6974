#include "server/call.h"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/errors.h"
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

class RunCallTest : public ::testing::Test {
 protected:
  static absl::Status Run(const Call& call, const std::function<absl::Status(const RunContext&)>& body) {
    return RunJobCall(call, {}, body);
  }
  Call MakeCall() {
    Call call;
    call.env = &env_;
    return call;
  }
  static ServerOptions Options() {
    ServerOptions options;
    options.threads = 2;
    options.max_jobs = 1;
    return options;
  }
  ServerEnv env_{Options()};
};

TEST_F(RunCallTest, ReturnsWhatTheWorkReturns) {
  EXPECT_TRUE(Run(MakeCall(), [](const RunContext&) { return absl::OkStatus(); }).ok());
  EXPECT_THAT(Run(MakeCall(), [](const RunContext&) { return absl::InternalError("x"); }),
              StatusIs(absl::StatusCode::kInternal, "x"));
}

TEST_F(RunCallTest, ObeysACancelWithin200Milliseconds) {
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
    EXPECT_THAT(Run(call, Endless), StatusIs(absl::StatusCode::kCancelled, _));
    const auto end = Clock::now();
    canceller.join();
    best = std::min(best, std::chrono::nanoseconds(end - at));
  }
  EXPECT_LT(best, 200ms);
}

TEST_F(RunCallTest, ObeysTheCallersDeadlineAndTheServersLimit) {
  Call call = MakeCall();
  call.deadline = Clock::now() + 50ms;
  EXPECT_THAT(Run(call, Endless), StatusIs(absl::StatusCode::kDeadlineExceeded, _));
  env_.options.max_job_seconds = 0.05;
  call.deadline.reset();
  EXPECT_THAT(Run(call, Endless), StatusIs(absl::StatusCode::kDeadlineExceeded, _));
}

TEST_F(RunCallTest, BeatsAtLeastTwiceASecondThoughNothingProgresses) {
  std::vector<Clock::time_point> beats = {Clock::now()};
  v1::Progress last;
  const Beat beat = [&](const v1::Progress& progress) {
    beats.push_back(Clock::now());
    last = progress;
    return true;
  };
  ASSERT_TRUE(RunJobCall(MakeCall(), {.beat = beat}, [](const RunContext& run) {
                run.Progress("zigzag: gaps", 0.5);
                std::this_thread::sleep_for(1100ms);
                return absl::OkStatus();
              }).ok());
  EXPECT_GE(beats.size(), 4u);
  for (std::size_t i = 1; i < beats.size(); ++i) EXPECT_LT(beats[i] - beats[i - 1], 500ms);
  EXPECT_EQ(last.stage(), "zigzag: gaps");
  EXPECT_EQ(last.fraction(), 0.5);
  EXPECT_EQ(last.job_stage(), v1::JOB_STAGE_PASSES);
  EXPECT_GT(last.overall_fraction(), 0.0);
}

TEST_F(RunCallTest, StopsWhenTheOtherSideIsGone) {
  EXPECT_THAT(RunJobCall(MakeCall(), {.beat = [](const v1::Progress&) { return false; }}, Endless),
              StatusIs(absl::StatusCode::kCancelled, _));
}

// One place: a second job waits, learns its place, and runs when the first has ended.
TEST_F(RunCallTest, AJobThatWaitsLearnsItsPlace) {
  std::atomic<bool> done{false};
  std::thread first([&] {
    (void)Run(MakeCall(), [&](const RunContext&) {
      while (!done.load()) std::this_thread::sleep_for(1ms);
      return absl::OkStatus();
    });
  });
  while (env_.jobs.running() == 0) std::this_thread::sleep_for(1ms);
  std::vector<v1::Progress> reported;
  const Beat beat = [&](const v1::Progress& progress) {
    reported.push_back(progress);
    done = true;
    return true;
  };
  EXPECT_TRUE(
      RunJobCall(MakeCall(), {.beat = beat}, [](const RunContext&) { return absl::OkStatus(); }).ok());
  first.join();
  ASSERT_FALSE(reported.empty());
  EXPECT_EQ(reported.front().queue_place(), 1);
  EXPECT_EQ(reported.front().job_stage(), v1::JOB_STAGE_QUEUED);
  // Calls of milliseconds have places of their own.
  std::thread job([&] { (void)Run(MakeCall(), Endless); });
  while (env_.jobs.running() == 0) std::this_thread::sleep_for(1ms);
  EXPECT_TRUE(RunQuickCall(MakeCall(), {}, [](const RunContext&) { return absl::OkStatus(); }).ok());
  env_.stopped = true;
  job.join();
}

TEST_F(RunCallTest, AStoppedServerEndsItsCallsWithItsReason) {
  std::thread stop([&] {
    while (env_.jobs.running() == 0) std::this_thread::sleep_for(1ms);
    env_.stopped = true;
  });
  EXPECT_THAT(Run(MakeCall(), Endless), StatusIs(absl::StatusCode::kUnavailable, HasSubstr("shutting down")));
  stop.join();
}

// Takes memory, as operator new does in the programs that serve.
absl::Status Take(const RunContext& run, std::int64_t bytes) {
  run.budget()->Add(bytes);
  return run.Check();
}

TEST_F(RunCallTest, AJobGetsMemoryUntilThereIsNone) {
  const std::int64_t all = env_.memory.limit();
  EXPECT_TRUE(Run(MakeCall(), [&](const RunContext& run) { return Take(run, all / 2); }).ok());
  EXPECT_EQ(env_.memory.taken(), 0);  // given back
  const absl::Status more = Run(MakeCall(), [&](const RunContext& run) { return Take(run, all + 1); });
  EXPECT_THAT(more, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("job_memory_bytes")));
  EXPECT_EQ(env_.memory.taken(), 0);
  // A job that only asks for time stops as soon as it has too much.
  EXPECT_THAT(Run(MakeCall(),
                  [&](const RunContext& run) {
                    run.budget()->Add(all + 1);
                    return Endless(run);
                  }),
              StatusIs(absl::StatusCode::kResourceExhausted, _));
}

TEST_F(RunCallTest, AnEstimateIsGrantedBeforeTheJobStarts) {
  const std::int64_t all = env_.memory.limit();
  bool ran = false;
  const auto body = [&](const RunContext&) {
    ran = true;
    return absl::OkStatus();
  };
  EXPECT_THAT(RunJobCall(MakeCall(), {.memory_bytes = all + 1}, body),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("estimated_job_memory_bytes")));
  ASSERT_TRUE(env_.memory.Take(all / 2));
  const absl::Status refused = RunJobCall(MakeCall(), {.memory_bytes = all / 4 * 3}, body);
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("try again later")));
  EXPECT_TRUE(RetryDelay(refused).has_value());
  EXPECT_FALSE(ran);
  env_.memory.Release(all / 2);
  EXPECT_TRUE(RunJobCall(MakeCall(), {.memory_bytes = all / 4 * 3}, body).ok());
}

TEST_F(RunCallTest, AnExceptionBecomesAStatus) {
  EXPECT_THAT(Run(MakeCall(), [](const RunContext&) -> absl::Status { throw std::runtime_error("odd"); }),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("odd")));
  EXPECT_THAT(Run(MakeCall(), [](const RunContext&) -> absl::Status { throw std::bad_alloc(); }),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("memory")));
}

// Of the one that talks, while the other works: it stops the work, and goes its way.
TEST_F(RunCallTest, AnExceptionOfTheBeatStopsTheWork) {
  const Beat beat = [](const v1::Progress&) -> bool { throw std::runtime_error("no memory"); };
  EXPECT_THROW((void)RunJobCall(MakeCall(), {.beat = beat}, Endless), std::runtime_error);
}

TEST_F(RunCallTest, ThreadsNeverExceedTheServers) {
  env_.options.threads = 2;
  const auto threads = [&](int asked) {
    int got = -1;
    EXPECT_TRUE(RunJobCall(MakeCall(), {.max_threads = asked}, [&](const RunContext& run) {
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

}  // namespace
}  // namespace patchmill
