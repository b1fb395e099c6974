#include "server/in_flight.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/errors.h"
#include "server/limits.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using testing::InfoOf;

std::string ReasonOf(const absl::Status& status) { return InfoOf(ToGrpcStatus(status)).reason(); }

TEST(InFlight, HoldsUpToItsLimitAndTakesBackWhatIsReleased) {
  InFlight in_flight(1000, {});
  auto first = in_flight.Take(600);
  ASSERT_TRUE(first.ok());
  const absl::Status refused = in_flight.Take(401).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(refused), "TOO_MANY_BYTES");
  EXPECT_EQ(InfoOf(ToGrpcStatus(refused)).limit_value(), 1000);
  EXPECT_EQ(InfoOf(ToGrpcStatus(refused)).actual_value(), 1001);
  EXPECT_TRUE(in_flight.Take(400).ok());  // given back at once
  {
    const InFlight::Hold moved = *std::move(first);
    EXPECT_FALSE(in_flight.Take(500).ok());
  }
  EXPECT_TRUE(in_flight.Take(1000).ok());
  // A request that can never fit gets another reason than one that may be sent again.
  EXPECT_EQ(ReasonOf(in_flight.Take(1001).status()), "LIMIT_EXCEEDED");
}

// A network of the test's own: peers, and what has come from each.
class OnTheWay : public ::testing::Test {
 protected:
  static constexpr std::size_t kMib = 1 << 20;

  struct Refused {
    std::mutex mutex;
    std::vector<std::string> names;
    absl::Status last;
    std::vector<std::string> Names() {
      const std::lock_guard<std::mutex> lock(mutex);
      return names;
    }
    bool WaitFor(std::size_t count) {
      for (int k = 0; k < 500 && Names().size() < count; ++k) std::this_thread::sleep_for(2ms);
      return Names().size() >= count;
    }
  };

  InFlight::Id Expect(const std::string& peer, const std::string& name) {
    return in_flight_.Expect(peer, [this, name](const absl::Status& status) {
      const std::lock_guard<std::mutex> lock(refused_.mutex);
      refused_.names.push_back(name);
      refused_.last = status;
    });
  }
  void Receive(const std::string& peer, std::uint64_t bytes) {
    const std::lock_guard<std::mutex> lock(mutex_);
    received_[peer] += bytes;
  }
  // Long enough for the measurements that would refuse.
  static void LetMeasure() { std::this_thread::sleep_for(8 * std::chrono::milliseconds(limits::kMeasureMs)); }

  std::mutex mutex_;
  std::map<std::string, std::uint64_t> received_;
  Refused refused_;
  InFlight in_flight_{100 * kMib, [this](const std::string& peer) -> std::optional<std::uint64_t> {
                        const std::lock_guard<std::mutex> lock(mutex_);
                        const auto at = received_.find(peer);
                        if (at == received_.end()) return std::nullopt;
                        return at->second;
                      }};
};

TEST_F(OnTheWay, WhoSendsTheMostIsRefused) {
  Receive("small", 7 * kMib);  // before: no request of now
  Receive("big", 500 * kMib);
  const InFlight::Id small = Expect("small", "small"), big = Expect("big", "big");
  Receive("small", 1 * kMib);
  Receive("big", 60 * kMib);
  LetMeasure();
  EXPECT_TRUE(refused_.Names().empty());
  auto held = in_flight_.Take(40 * kMib);
  ASSERT_TRUE(held.ok());
  ASSERT_TRUE(refused_.WaitFor(1));
  EXPECT_EQ(refused_.Names(), std::vector<std::string>{"big"});
  EXPECT_EQ(ReasonOf(refused_.last), "TOO_MANY_BYTES");
  LetMeasure();
  EXPECT_EQ(refused_.Names().size(), 1u);  // once, and nobody else
  in_flight_.Arrived(big, 0);
  in_flight_.Arrived(small, kMib);
}

TEST_F(OnTheWay, OfOneConnectionTheNewestCallIsRefused) {
  std::vector<InFlight::Id> ids;
  for (const char* name : {"a", "b", "c"}) ids.push_back(Expect("peer", name));
  Receive("peer", 110 * kMib);
  ASSERT_TRUE(refused_.WaitFor(1));
  LetMeasure();
  EXPECT_EQ(refused_.Names(), std::vector<std::string>{"c"});
  for (const InFlight::Id id : ids) in_flight_.Arrived(id, 0);
}

// What has arrived is held by its call, and no longer on its way.
TEST_F(OnTheWay, WhatHasArrivedIsNotCountedTwice) {
  const InFlight::Id one = Expect("peer", "one"), two = Expect("peer", "two");
  Receive("peer", 60 * kMib);
  in_flight_.Arrived(one, 60 * kMib);
  auto held = in_flight_.Take(60 * kMib);
  ASSERT_TRUE(held.ok());
  Receive("peer", 30 * kMib);
  LetMeasure();
  EXPECT_TRUE(refused_.Names().empty());
  Receive("peer", 11 * kMib);
  EXPECT_TRUE(refused_.WaitFor(1));
  in_flight_.Arrived(two, 0);
}

// gRPC reads a message to its end, however long it is.
TEST_F(OnTheWay, AMessageThatIsTooLongIsRefusedWhileItComes) {
  const InFlight::Id id = Expect("peer", "long");
  Receive("peer", 70 * kMib);
  LetMeasure();
  EXPECT_TRUE(refused_.Names().empty());
  Receive("peer", 11 * kMib);
  ASSERT_TRUE(refused_.WaitFor(1));
  EXPECT_EQ(ReasonOf(refused_.last), "LIMIT_EXCEEDED");
  EXPECT_EQ(InfoOf(ToGrpcStatus(refused_.last)).limit(), "message_bytes");
  // What came is not counted as of the next.
  const InFlight::Id next = Expect("peer", "next");
  in_flight_.Arrived(id, 0);
  Receive("peer", 30 * kMib);
  LetMeasure();
  EXPECT_EQ(refused_.Names().size(), 1u);
  in_flight_.Arrived(next, 0);
}

// New calls that send nothing do not stand in for an old one that sends much without an end.
TEST_F(OnTheWay, NewCallsShieldAnOldOneForAWhileOnly) {
  const InFlight::Id old = Expect("peer", "old");
  const auto is_refused = [this] {
    const std::vector<std::string> names = refused_.Names();
    return std::find(names.begin(), names.end(), "old") != names.end();
  };
  std::size_t shields = 0;
  for (; shields < 10 && !is_refused(); ++shields) {
    const std::size_t before = refused_.Names().size();
    const InFlight::Id shield = Expect("peer", "shield");
    Receive("peer", 60 * kMib);
    refused_.WaitFor(before + (shields > 0 ? 1 : 0));
    LetMeasure();
    in_flight_.Arrived(shield, 0);
  }
  EXPECT_TRUE(is_refused());
  EXPECT_LT(shields, 10u);
  in_flight_.Arrived(old, 0);
}

TEST_F(OnTheWay, AnIdleCallCostsNothing) {
  std::vector<InFlight::Id> ids;
  for (int k = 0; k < 1000; ++k) ids.push_back(Expect("idle " + std::to_string(k), "idle"));
  const InFlight::Id id = Expect("peer", "peer");
  Receive("peer", 64 * kMib);
  EXPECT_TRUE(in_flight_.Take(30 * kMib).ok());
  LetMeasure();
  EXPECT_TRUE(refused_.Names().empty());
  in_flight_.Arrived(id, 64 * kMib);
  for (const InFlight::Id idle : ids) in_flight_.Arrived(idle, 0);
}

}  // namespace
}  // namespace patchmill
