#include "server/operate/callers.h"

#include <algorithm>
#include <utility>

#include <absl/strings/ascii.h>
#include <absl/strings/match.h>
#include <fmt/format.h>
#include <openssl/crypto.h>

#include "core/base/digest.h"
#include "core/base/status.h"
#include "server/operate/caller_errors.h"

namespace patchmill {
namespace {

constexpr char kSend[] = "send the metadata authorization: Bearer TOKEN (patchmill: --token-file FILE)";

std::chrono::milliseconds Milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * seconds) + 1);
}

}  // namespace

void Callers::Set(CallerTable table) {
  const std::lock_guard<std::mutex> lock(mutex_);
  table_ = std::move(table);
  std::erase_if(accounts_, [&](const auto& account) { return !table_->callers.contains(account.first); });
}

absl::StatusOr<std::string> Callers::Name(const Presented& presented) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!table_) return presented.certificate;
  if (presented.authorization) return OfToken(*presented.authorization);
  if (!presented.certificate.empty()) return presented.certificate;
  return UnauthenticatedError("TOKEN_MISSING", fmt::format("the call has no token; {}", kSend));
}

absl::StatusOr<std::string> Callers::Admit(const Presented& presented) {
  PM_ASSIGN_OR_RETURN(std::string caller, Name(presented));
  const std::lock_guard<std::mutex> lock(mutex_);
  PM_RETURN_IF_ERROR(TakeRequest(caller));
  return caller;
}

absl::StatusOr<std::string> Callers::OfToken(std::string_view authorization) const {
  constexpr std::string_view kScheme = "bearer ";
  absl::string_view value(authorization.data(), authorization.size());
  if (!absl::StartsWithIgnoreCase(value, absl::string_view(kScheme.data(), kScheme.size()))) {
    return UnauthenticatedError("TOKEN_UNREADABLE",
                                fmt::format("authorization is no bearer token; {}", kSend));
  }
  value = absl::StripAsciiWhitespace(value.substr(kScheme.size()));
  const std::string digest = Sha256({value.data(), value.size()});
  // Every token is compared to its end, so that the time tells nothing about them.
  const CallerToken* found = nullptr;
  for (const CallerToken& token : table_->tokens) {
    if (CRYPTO_memcmp(token.digest.data(), digest.data(), digest.size()) == 0) found = &token;
  }
  if (found == nullptr) {
    return UnauthenticatedError("TOKEN_UNKNOWN",
                                "the token is none of this server's; ask its operator for one");
  }
  if (clocks_.wall() >= found->until) {
    return UnauthenticatedError(
        "TOKEN_EXPIRED",
        fmt::format("the token of {} has expired; ask the server's operator for another", found->caller));
  }
  return found->caller;
}

Quotas Callers::QuotasLocked(const std::string& caller) const {
  if (!table_) return {};
  const auto at = table_->callers.find(caller);
  return at == table_->callers.end() ? Quotas() : at->second;
}

Quotas Callers::QuotasOf(const std::string& caller) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return QuotasLocked(caller);
}

absl::Status Callers::TakeRequest(const std::string& caller) {
  const std::optional<int> quota = QuotasLocked(caller).requests_per_minute;
  if (!quota) return absl::OkStatus();
  const auto now = clocks_.steady();
  Account& account = accounts_[caller];
  const double per_second = *quota / 60.0;
  const double passed = std::chrono::duration<double>(now - account.filled).count();
  account.requests =
      account.started ? std::min<double>(*quota, account.requests + passed * per_second) : *quota;
  account.started = true;
  account.filled = now;
  if (account.requests >= 1.0) {
    account.requests -= 1.0;
    return absl::OkStatus();
  }
  return QuotaError("caller_requests_per_minute", *quota, *quota + 1.0,
                    Milliseconds((1.0 - account.requests) / per_second));
}

absl::Status Callers::TakeJobSeconds(const std::string& caller, double seconds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::optional<double> quota = QuotasLocked(caller).job_seconds_per_day;
  if (!quota) return absl::OkStatus();
  constexpr double kDay = 86400.0;
  const double now = std::chrono::duration<double>(clocks_.wall().time_since_epoch()).count();
  const auto day = static_cast<std::int64_t>(now / kDay);
  Account& account = accounts_[caller];
  if (account.day != day) account.job_seconds = 0.0;
  account.day = day;
  account.job_seconds += seconds;
  if (account.job_seconds < *quota) return absl::OkStatus();
  return QuotaError("caller_job_seconds_per_day", *quota, account.job_seconds,
                    Milliseconds(kDay * static_cast<double>(day + 1) - now));
}

}  // namespace patchmill
