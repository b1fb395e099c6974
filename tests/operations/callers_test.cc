#include "server/operate/callers.h"

#include <cmath>
#include <future>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/errors.h"
#include "server/places.h"
#include "server/store.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using ::testing::_;
using ::testing::HasSubstr;
using testing::StatusIs;

constexpr auto kExhausted = absl::StatusCode::kResourceExhausted;
constexpr auto kUnauthenticated = absl::StatusCode::kUnauthenticated;

std::string ReasonOf(const absl::Status& status) { return testing::InfoOf(ToGrpcStatus(status)).reason(); }

class CallersOf {
 public:
  explicit CallersOf(const char* file) : callers({[this] { return wall; }, [this] { return steady; }}) {
    Set(file);
  }
  void Set(const char* file) {
    auto table = ParseCallers(file, "tokens.conf", true);
    ASSERT_TRUE(table.ok()) << table.status();
    callers.Set(*std::move(table));
  }
  absl::StatusOr<std::string> With(const char* authorization) {
    return callers.Admit({authorization, "cert"});
  }

  std::chrono::system_clock::time_point wall{std::chrono::hours(24) * 20'000};  // a midnight
  std::chrono::steady_clock::time_point steady;
  Callers callers;
};

TEST(Callers, WithoutAFileTheCertificateNamesTheCaller) {
  Callers callers;
  EXPECT_EQ(*callers.Admit({std::nullopt, "shop"}), "shop");
  EXPECT_EQ(*callers.Admit({"Bearer whatever", ""}), "");
}

TEST(Callers, ATokenNamesTheCallerBeforeTheCertificateDoes) {
  CallersOf of("[a]\ntoken = text:0123456789abcdef\n[b]\ntoken = text:0123456789abcdeg\n");
  EXPECT_EQ(*of.With("Bearer 0123456789abcdef"), "a");
  EXPECT_EQ(*of.With("bearer  0123456789abcdeg"), "b");
  EXPECT_EQ(*of.callers.Admit({std::nullopt, "cert"}), "cert");
}

TEST(Callers, EachRefusalHasItsReason) {
  CallersOf of("[a]\ntoken = text:0123456789abcdef until 2024-10-04\ntoken = text:0123456789abcdeg\n");
  const auto refused = [&](const absl::StatusOr<std::string>& caller, const std::string& reason) {
    EXPECT_THAT(caller.status(), StatusIs(kUnauthenticated, _));
    EXPECT_EQ(ReasonOf(caller.status()), reason);
  };
  refused(of.callers.Admit({std::nullopt, ""}), "TOKEN_MISSING");
  refused(of.With("Basic dXNlcg=="), "TOKEN_UNREADABLE");
  refused(of.With("Bearer 0123456789abcde"), "TOKEN_UNKNOWN");
  refused(of.With("Bearer "), "TOKEN_UNKNOWN");
  EXPECT_EQ(*of.With("Bearer 0123456789abcdef"), "a");  // 2024-10-04 is day 20,000 since 1970
  of.wall += 24h;
  refused(of.With("Bearer 0123456789abcdef"), "TOKEN_EXPIRED");
  EXPECT_EQ(*of.With("Bearer 0123456789abcdeg"), "a");  // the other token is still good
}

TEST(Callers, AnotherFileCountsAtOnceAndWhatWasTakenStaysCounted) {
  CallersOf of("[a]\ntoken = text:0123456789abcdef\nrequests_per_minute = 1\n");
  EXPECT_TRUE(of.With("Bearer 0123456789abcdef").ok());
  of.Set("[a]\ntoken = text:0123456789abcdeg\nrequests_per_minute = 1\n");
  EXPECT_EQ(ReasonOf(of.With("Bearer 0123456789abcdef").status()), "TOKEN_UNKNOWN");
  EXPECT_EQ(ReasonOf(of.With("Bearer 0123456789abcdeg").status()), "QUOTA_EXCEEDED");
}

TEST(Callers, RequestsComeBackWithTheMinute) {
  CallersOf of(
      "[a]\ntoken = text:0123456789abcdef\nrequests_per_minute = 30\n[b]\ntoken = text:0123456789abcdeg\n");
  for (int k = 0; k < 30; ++k) ASSERT_TRUE(of.With("Bearer 0123456789abcdef").ok()) << k;
  const absl::Status refused = of.With("Bearer 0123456789abcdef").status();
  EXPECT_THAT(refused, StatusIs(kExhausted, HasSubstr("caller_requests_per_minute")));
  ASSERT_TRUE(RetryDelay(refused));
  EXPECT_NEAR(static_cast<double>(RetryDelay(refused)->count()), 2000.0, 1.0);  // 30 a minute are one in 2 s
  EXPECT_TRUE(of.With("Bearer 0123456789abcdeg").ok());                         // another caller has its own
  of.steady += *RetryDelay(refused);
  EXPECT_TRUE(of.With("Bearer 0123456789abcdef").ok());
  EXPECT_FALSE(of.With("Bearer 0123456789abcdef").ok());
  of.steady += std::chrono::hours(24);  // never more than those of one minute at once
  for (int k = 0; k < 30; ++k) ASSERT_TRUE(of.With("Bearer 0123456789abcdef").ok()) << k;
  EXPECT_FALSE(of.With("Bearer 0123456789abcdef").ok());
}

TEST(Callers, SecondsOfJobsComeBackAtMidnight) {
  CallersOf of("[a]\ntoken = text:0123456789abcdef\njob_seconds_per_day = 100\n");
  of.wall += 23h;
  EXPECT_TRUE(of.callers.TakeJobSeconds("a", 99.0).ok());
  const absl::Status used_up = of.callers.TakeJobSeconds("a", 1.0);
  EXPECT_THAT(used_up, StatusIs(kExhausted, HasSubstr("caller_job_seconds_per_day = 100")));
  EXPECT_NEAR(static_cast<double>(RetryDelay(used_up)->count()), 3'600'000.0, 2.0);
  EXPECT_FALSE(of.callers.TakeJobSeconds("a", 0.0).ok());
  EXPECT_TRUE(of.callers.TakeJobSeconds("nobody", 1e9).ok());
  of.wall += 1h;
  EXPECT_TRUE(of.callers.TakeJobSeconds("a", 0.0).ok());
}

TEST(PlacesOfACaller, AreNotExceededWhileOthersAreFree) {
  Places places(3, 100);
  const auto first = places.Enter({.caller = "a", .most = 1, .gone = {}, .on_place = {}});
  ASSERT_TRUE(first.ok());
  bool waits = false;
  const auto second = places.Enter({.caller = "a",
                                    .most = 1,
                                    .gone = [&] { return waits; },
                                    .on_place = [&](int) { waits = true; },
                                    .poll = 1ms});
  EXPECT_TRUE(waits);  // though two places were free
  EXPECT_THAT(second.status(), StatusIs(absl::StatusCode::kCancelled, _));
  EXPECT_TRUE(places.Enter({.caller = "b", .most = 1, .gone = {}, .on_place = {}}).ok());
}

TEST(PlacesOfACaller, AFreedPlaceGoesToItsNextJob) {
  Places places(3, 100);
  auto first = std::make_optional(places.Enter({.caller = "a", .most = 1, .gone = {}, .on_place = {}}));
  auto second = std::async(std::launch::async, [&] {
    return places.Enter({.caller = "a", .most = 1, .gone = {}, .on_place = {}, .poll = 1ms}).ok();
  });
  while (places.waiting() == 0) std::this_thread::sleep_for(1ms);
  first.reset();
  EXPECT_TRUE(second.get());
}

TEST(PlacesOfACaller, OneCallerCannotFillTheQueue) {
  Places places(3, 100);
  const auto running = places.Enter({.caller = "a", .most = 1, .gone = {}, .on_place = {}});
  std::atomic<bool> end{false};
  std::vector<std::future<void>> waiting;
  for (int k = 0; k < 4; ++k) {
    waiting.push_back(std::async(std::launch::async, [&] {
      (void)places.Enter(
          {.caller = "a", .most = 1, .gone = [&] { return end.load(); }, .on_place = {}, .poll = 1ms});
    }));
  }
  while (places.waiting() < 4) std::this_thread::sleep_for(1ms);
  const absl::Status refused = places.Enter({.caller = "a", .most = 1, .gone = {}, .on_place = {}}).status();
  EXPECT_THAT(refused, StatusIs(kExhausted, HasSubstr("caller_jobs")));
  EXPECT_EQ(ReasonOf(refused), "QUOTA_EXCEEDED");
  EXPECT_TRUE(RetryDelay(refused));
  end = true;
}

std::shared_ptr<const int> Value() { return std::make_shared<const int>(1); }

TEST(StoreOfACaller, ACallerBeyondItsShareLosesItsOwnValues) {
  Store store(100'000, [](const std::string& caller) {
    return caller == "a" ? std::optional<std::int64_t>(20'000) : std::nullopt;
  });
  const auto key = [](const char* caller, const char* digest) {
    return StoreKey{Stored::kModel, caller, digest};
  };
  EXPECT_TRUE(store.Put<int>(key("b", "0"), Value(), 9'000));  // used longest ago of all
  EXPECT_TRUE(store.Put<int>(key("a", "1"), Value(), 9'000));
  EXPECT_TRUE(store.Put<int>(key("a", "2"), Value(), 9'000));
  EXPECT_TRUE(store.Put<int>(key("a", "3"), Value(), 9'000));
  EXPECT_EQ(store.Find<int>(key("a", "1")), nullptr);
  EXPECT_NE(store.Find<int>(key("a", "2")), nullptr);
  EXPECT_NE(store.Find<int>(key("a", "3")), nullptr);
  EXPECT_NE(store.Find<int>(key("b", "0")), nullptr);
  EXPECT_FALSE(store.Put<int>(key("a", "4"), Value(), 30'000));
  EXPECT_TRUE(store.Put<int>(key("b", "4"), Value(), 30'000));
  EXPECT_EQ(store.LimitOf("a"), 20'000u);
  EXPECT_EQ(store.LimitOf("b"), 100'000u);
}

}  // namespace
}  // namespace patchmill
