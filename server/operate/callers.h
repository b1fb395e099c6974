// Who calls, and how much each caller has taken of what it may take.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "server/operate/callers_file.h"

namespace patchmill {

// What a call shows of its caller.
struct Presented {
  std::optional<std::string> authorization;  // the metadata of that name
  std::string certificate;                   // common name of the client certificate; empty without one
};

// Both clocks. A test sets them.
struct Clocks {
  std::function<std::chrono::system_clock::time_point()> wall = std::chrono::system_clock::now;
  std::function<std::chrono::steady_clock::time_point()> steady = std::chrono::steady_clock::now;
};

// Any thread may call it.
class Callers {
 public:
  explicit Callers(Clocks clocks = {}) : clocks_(std::move(clocks)) {}
  Callers(const Callers&) = delete;
  Callers& operator=(const Callers&) = delete;

  // Sets who may call. What callers have taken stays counted. Before the first call of it anybody may call.
  void Set(CallerTable table);

  // The name of the caller: of its token, or else of its certificate. Empty where callers are not told
  // apart. UNAUTHENTICATED: TOKEN_MISSING (no token and no certificate), TOKEN_UNREADABLE, TOKEN_UNKNOWN,
  // TOKEN_EXPIRED. RESOURCE_EXHAUSTED QUOTA_EXCEEDED: too many requests in this minute.
  absl::StatusOr<std::string> Admit(const Presented& presented);
  // The same without counting a request.
  absl::StatusOr<std::string> Name(const Presented& presented) const;

  Quotas QuotasOf(const std::string& caller) const;
  // Counts `seconds` of a job of the caller. RESOURCE_EXHAUSTED QUOTA_EXCEEDED if those of this day are used
  // up. With 0 it only asks.
  absl::Status TakeJobSeconds(const std::string& caller, double seconds);

 private:
  struct Account {
    double requests = 0.0;  // that may come at once
    std::chrono::steady_clock::time_point filled;
    bool started = false;
    std::int64_t day = 0;  // since 1970, UTC
    double job_seconds = 0.0;
  };

  absl::StatusOr<std::string> OfToken(std::string_view authorization) const;  // with the mutex locked
  absl::Status TakeRequest(const std::string& caller);                        // with the mutex locked
  Quotas QuotasLocked(const std::string& caller) const;

  const Clocks clocks_;
  mutable std::mutex mutex_;
  std::optional<CallerTable> table_;
  std::map<std::string, Account> accounts_;  // of callers with quotas
};

}  // namespace patchmill
