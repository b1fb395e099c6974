// The file of --tokens: who may call, with which tokens, and how much of the server each caller may take.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

namespace patchmill {

// What one caller may take. An absent number: only the limits of the server hold.
struct Quotas {
  std::optional<int> places;                  // jobs that run at once
  std::optional<int> requests_per_minute;     // calls of every kind
  std::optional<double> job_seconds_per_day;  // sum over jobs, by the clock; days end at midnight UTC
  std::optional<std::int64_t> store_bytes;    // models, CAD files and answers that are kept in memory
};

struct CallerToken {
  std::string digest;  // SHA-256 of the token, 32 bytes
  std::string caller;
  std::chrono::system_clock::time_point until;  // the token is refused from then on; max(): never
};

struct CallerTable {
  std::map<std::string, Quotas> callers;
  std::vector<CallerToken> tokens;
};

// Reads a file of callers. `certificates`: whether clients may show a certificate of --ca in place of a
// token; only then a caller may be without a token. INVALID_ARGUMENT with the line, what is wrong with it,
// and what belongs there; no message holds a token.
//
//   [shop-a]                                       # one section for each caller
//   token = sha256:9f86d08...                      # SHA-256 of the token in 64 hex digits
//   token = text:0123456789abcdef until 2027-01-31 # or the token itself; at most two
//   places = 2
//   requests_per_minute = 600
//   job_seconds_per_day = 7200
//   store_mib = 64
absl::StatusOr<CallerTable> ReadCallers(const std::string& path, bool certificates);
// The same for the text of a file.
absl::StatusOr<CallerTable> ParseCallers(std::string_view text, std::string_view path, bool certificates);

}  // namespace patchmill
