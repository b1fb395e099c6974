#include "server/places.h"

#include <atomic>
#include <chrono>
#include <future>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using ::testing::_;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::StatusIs;

void WaitUntil(const std::function<bool()>& what) {
  for (int k = 0; k < 2000 && !what(); ++k) std::this_thread::sleep_for(1ms);
  ASSERT_TRUE(what());
}

// A call that enters in a thread of its own, notes its name, and leaves at once.
struct Calls {
  explicit Calls(Places& p) : places(p) {}
  ~Calls() {
    for (std::thread& thread : threads) thread.join();
  }
  // Returns when the call waits.
  void Wait(const std::string& caller, const std::string& name) {
    const int before = places.waiting();
    threads.emplace_back([this, caller, name] {
      const auto ticket = places.Enter({.caller = caller, .gone = {}, .on_place = {}});
      const std::lock_guard<std::mutex> lock(mutex);
      order.push_back(ticket.ok() ? name : name + " refused");
    });
    WaitUntil([&] { return places.waiting() == before + 1; });
  }
  Places& places;
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::vector<std::string> order;
};

TEST(Places, LetInAsManyAsThereAreAndTheOthersInOrder) {
  Places places(2, 10);
  auto first = places.Enter({});
  auto second = places.Enter({});
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_EQ(places.running(), 2);
  std::vector<std::string> order;
  {
    Calls calls(places);
    for (const char* name : {"a", "b", "c"}) calls.Wait("", name);
    { const auto leaving = *std::move(first); }
    WaitUntil([&] { return places.waiting() == 0 && places.running() == 1; });
    order = calls.order;
  }
  EXPECT_THAT(order, ElementsAre("a", "b", "c"));
}

// One caller waits with four calls before another one comes: they take turns.
TEST(Places, ACallerWithManyCallsDoesNotKeepOutAnother) {
  Places places(2, 10);
  auto one = places.Enter({.caller = "many", .gone = {}, .on_place = {}});
  auto two = places.Enter({.caller = "many", .gone = {}, .on_place = {}});
  std::vector<std::string> order;
  {
    Calls calls(places);
    for (const char* name : {"m1", "m2"}) calls.Wait("many", name);
    calls.Wait("few", "f1");
    { const auto leaving = *std::move(one); }
    WaitUntil([&] { return places.waiting() == 0; });
    WaitUntil([&] { return places.running() == 1; });
    order = calls.order;
  }
  EXPECT_EQ(order.front(), "f1");
}

TEST(Places, AFullQueueRefuses) {
  Places places(1, 1);
  auto first = places.Enter({});
  Calls calls(places);
  calls.Wait("", "waits");
  EXPECT_THAT(places.Enter({}).status(),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("1 jobs and 1 wait")));
  { const auto leaving = *std::move(first); }
}

TEST(Places, ACallThatIsGoneStopsWaitingAndLearnsItsPlace) {
  Places places(1, 5);
  auto first = places.Enter({});
  std::atomic<bool> gone{false};
  std::atomic<int> place{0};
  auto waits = std::async(std::launch::async, [&] {
    return places
        .Enter({.caller = "",
                .gone = [&] { return gone.load(); },
                .on_place = [&](int k) { place = k; },
                .poll = 5ms})
        .status();
  });
  WaitUntil([&] { return place == 1; });
  gone = true;
  EXPECT_THAT(waits.get(), StatusIs(absl::StatusCode::kCancelled, _));
  EXPECT_EQ(places.waiting(), 0);
  { const auto leaving = *std::move(first); }
  EXPECT_EQ(places.running(), 0);
  EXPECT_TRUE(places.Enter({}).ok());
}

TEST(Places, WhileTheServerDrainsNobodyEntersOrWaits) {
  Places places(1, 5);
  auto first = places.Enter({});
  auto waits = std::async(std::launch::async, [&] { return places.Enter({}).status(); });
  WaitUntil([&] { return places.waiting() == 1; });
  places.Drain();
  EXPECT_THAT(waits.get(), StatusIs(absl::StatusCode::kUnavailable, _));
  EXPECT_THAT(places.Enter({}).status(), StatusIs(absl::StatusCode::kUnavailable, _));
  EXPECT_THAT(places.CheckOpen(), StatusIs(absl::StatusCode::kUnavailable, _));
}

// Whatever the order of events, a place is never lost and never given twice.
TEST(Places, ManyThreadsNeverExceedTheNumber) {
  Places places(3, 1000);
  std::atomic<int> inside{0}, most{0}, entered{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 16; ++t) {
    threads.emplace_back([&, t] {
      for (int k = 0; k < 50; ++k) {
        std::atomic<int> asked{0};
        const auto ticket = places.Enter({.caller = std::to_string(t % 3),
                                          .gone = [&] { return k % 5 == 4 && ++asked > 1; },
                                          .on_place = {},
                                          .poll = 1ms});
        if (!ticket.ok()) continue;
        ++entered;
        const int now = ++inside;
        for (int before = most; now > before && !most.compare_exchange_weak(before, now);) {
        }
        std::this_thread::sleep_for(20us);
        --inside;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_LE(most, 3);
  EXPECT_GE(entered, 16 * 40);
  EXPECT_EQ(places.running(), 0);
  EXPECT_EQ(places.waiting(), 0);
}

}  // namespace
}  // namespace patchmill
