#include "server/operate/callers_file.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include <absl/strings/ascii.h>
#include <absl/strings/escaping.h>
#include <absl/strings/numbers.h>
#include <absl/strings/str_split.h>
#include <absl/strings/strip.h>
#include <absl/time/civil_time.h>
#include <absl/time/time.h>
#include <fmt/format.h>

#include "core/base/digest.h"
#include "core/base/status.h"
#include "server/limits.h"

namespace patchmill {
namespace {

constexpr std::size_t kMaxCallersBytes = std::size_t{1} << 20;
constexpr std::size_t kMaxCallers = 1000;
constexpr std::size_t kMaxCallerName = 64;  // of a common name, too (X.520)
constexpr std::size_t kMinTokenBytes = 16, kMaxTokenBytes = 512;
constexpr int kMaxTokensOfCaller = 2;  // one while the other is renewed

std::string Plain(absl::string_view text) { return std::string(text.data(), text.size()); }

// Characters of a bearer token (RFC 6750, section 2.1).
bool IsTokenCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("-._~+/=").find(c) != std::string_view::npos;
}

absl::StatusOr<std::chrono::system_clock::time_point> TimeOf(absl::string_view text) {
  absl::Time time;
  absl::CivilDay day;
  std::string error;
  if (absl::ParseCivilTime(text, &day)) {
    time = absl::FromCivil(day + 1, absl::UTCTimeZone());
  } else if (!absl::ParseTime(absl::RFC3339_full, text, &time, &error)) {
    return absl::InvalidArgumentError(fmt::format(
        "until {}; must be a day (2027-01-31, to its end in UTC) or a time (2027-01-31T12:00:00Z)",
        Plain(text)));
  }
  return absl::ToChronoTime(time);
}

class Reader {
 public:
  Reader(std::string_view path, bool certificates) : path_(path), certificates_(certificates) {}

  absl::Status Line(absl::string_view line) {
    ++line_;
    line = absl::StripAsciiWhitespace(line.substr(0, line.find('#')));
    if (line.empty()) return absl::OkStatus();
    if (line.front() == '[') return Section(line);
    const std::pair<absl::string_view, absl::string_view> parts =
        absl::StrSplit(line, absl::MaxSplits('=', 1));
    const std::string key = Plain(absl::StripAsciiWhitespace(parts.first));
    if (line.find('=') == absl::string_view::npos) {
      return Fault("is no \"key = value\", no \"[caller]\" and no comment");
    }
    if (caller_.empty())
      return Fault(fmt::format("{} stands above the first caller; begin with a line [caller]", key));
    const absl::string_view value = absl::StripAsciiWhitespace(parts.second);
    if (key == "token") return Token(value);
    if (!keys_.insert(key).second) return Fault(fmt::format("{} stands twice below [{}]", key, caller_));
    return Quota(key, value);
  }

  absl::StatusOr<CallerTable> End() {
    if (table_.callers.empty()) {
      return absl::InvalidArgumentError(fmt::format(
          "{} has no caller, so nobody could call; add a line [caller] and a line token = sha256:...",
          path_));
    }
    PM_RETURN_IF_ERROR(EndSection());
    return std::move(table_);
  }

 private:
  absl::Status Fault(std::string_view text) const {
    return absl::InvalidArgumentError(fmt::format("{}, line {}: {}", path_, line_, text));
  }

  absl::Status EndSection() const {
    if (caller_.empty() || tokens_ > 0 || certificates_) return absl::OkStatus();
    return absl::InvalidArgumentError(fmt::format(
        "{}, line {}: caller {} has no token; add one, or let clients show certificates with --ca", path_,
        section_line_, caller_));
  }

  absl::Status Section(absl::string_view line) {
    PM_RETURN_IF_ERROR(EndSection());
    if (line.back() != ']') return Fault("has no ] at its end; a caller begins with a line [caller]");
    const std::string name = Plain(absl::StripAsciiWhitespace(line.substr(1, line.size() - 2)));
    const bool printable = std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
    if (name.empty() || name.size() > kMaxCallerName || !printable) {
      return Fault(
          fmt::format("the name of a caller must have 1 to {} printable ASCII characters", kMaxCallerName));
    }
    if (!table_.callers.emplace(name, Quotas()).second) {
      return Fault(fmt::format("caller {} stands twice; join both sections", name));
    }
    if (table_.callers.size() > kMaxCallers) return Fault(fmt::format("more than {} callers", kMaxCallers));
    caller_ = name;
    section_line_ = line_;
    keys_.clear();
    tokens_ = 0;
    return absl::OkStatus();
  }

  absl::Status Token(absl::string_view value) {
    CallerToken token{{}, caller_, std::chrono::system_clock::time_point::max()};
    const std::vector<absl::string_view> words =
        absl::StrSplit(value, absl::ByAnyChar(" \t"), absl::SkipEmpty());
    if (words.size() == 3 && words[1] == "until") {
      const auto until = TimeOf(words[2]);
      if (!until.ok()) return Fault(std::string(until.status().message()));
      token.until = *until;
    } else if (words.size() != 1) {
      return Fault("a token is sha256:HEX or text:TOKEN, and may end with: until 2027-01-31");
    }
    absl::string_view secret = words[0];
    if (absl::ConsumePrefix(&secret, "sha256:")) {
      const bool hex = std::all_of(secret.begin(), secret.end(),
                                   [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; });
      if (!hex || secret.size() != 64)
        return Fault("sha256: must be followed by 64 hex digits, the SHA-256 of a token");
      token.digest = absl::HexStringToBytes(secret);
    } else if (absl::ConsumePrefix(&secret, "text:")) {
      if (secret.size() < kMinTokenBytes || secret.size() > kMaxTokenBytes ||
          !std::all_of(secret.begin(), secret.end(), IsTokenCharacter)) {
        return Fault(fmt::format("text: must be followed by {} to {} letters, digits and -._~+/=",
                                 kMinTokenBytes, kMaxTokenBytes));
      }
      token.digest = Sha256({secret.data(), secret.size()});
    } else {
      return Fault("a token begins with sha256: or text:");
    }
    if (++tokens_ > kMaxTokensOfCaller) {
      return Fault(fmt::format("caller {} has more than two tokens; remove the oldest", caller_));
    }
    if (!digests_.insert(token.digest).second) return Fault("this token stands in the file already");
    table_.tokens.push_back(std::move(token));
    return absl::OkStatus();
  }

  absl::StatusOr<std::int64_t> Number(const std::string& key, absl::string_view value,
                                      std::int64_t most) const {
    std::int64_t number = 0;
    if (absl::SimpleAtoi(value, &number) && number >= 1 && number <= most) return number;
    return Fault(fmt::format("{} = {}; must be a whole number from 1 to {}", key, Plain(value), most));
  }

  absl::Status Quota(const std::string& key, absl::string_view value) {
    Quotas& quotas = table_.callers[caller_];
    if (key == "places") {
      PM_ASSIGN_OR_RETURN(quotas.places, Number(key, value, limits::kMaxJobs));
    } else if (key == "requests_per_minute") {
      PM_ASSIGN_OR_RETURN(quotas.requests_per_minute, Number(key, value, 1'000'000));
    } else if (key == "job_seconds_per_day") {
      PM_ASSIGN_OR_RETURN(quotas.job_seconds_per_day,
                          Number(key, value, 86'400 * std::int64_t{limits::kMaxJobs}));
    } else if (key == "store_mib") {
      PM_ASSIGN_OR_RETURN(const std::int64_t mib, Number(key, value, 1 << 20));
      quotas.store_bytes = mib << 20;
    } else {
      return Fault(
          fmt::format("unknown key {}; a caller has token, places, requests_per_minute, job_seconds_per_day "
                      "and store_mib",
                      key));
    }
    return absl::OkStatus();
  }

  const std::string path_;
  const bool certificates_;
  CallerTable table_;
  std::string caller_;
  std::set<std::string> keys_, digests_;
  int line_ = 0, section_line_ = 0, tokens_ = 0;
};

}  // namespace

absl::StatusOr<CallerTable> ParseCallers(std::string_view text, std::string_view path, bool certificates) {
  Reader reader(path, certificates);
  for (const absl::string_view line : absl::StrSplit(absl::string_view(text.data(), text.size()), '\n')) {
    PM_RETURN_IF_ERROR(reader.Line(line));
  }
  return reader.End();
}

absl::StatusOr<CallerTable> ReadCallers(const std::string& path, bool certificates) {
  std::ifstream in(path, std::ios::binary);
  std::string text(kMaxCallersBytes + 1, '\0');
  if (!in || (!in.read(text.data(), static_cast<std::streamsize>(text.size())) && in.bad())) {
    return absl::InvalidArgumentError(fmt::format("--tokens {}: cannot be read", path));
  }
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.empty()) {
    return absl::InvalidArgumentError(fmt::format("--tokens {}: cannot be read, or is empty", path));
  }
  if (text.size() > kMaxCallersBytes) {
    return absl::InvalidArgumentError(
        fmt::format("--tokens {}: has more than {} bytes", path, kMaxCallersBytes));
  }
  return ParseCallers(text, path, certificates);
}

}  // namespace patchmill
