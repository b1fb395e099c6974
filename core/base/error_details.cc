#include "core/base/error_details.h"

#include <utility>
#include <vector>

#include <absl/strings/cord.h>
#include <absl/strings/numbers.h>
#include <absl/strings/str_split.h>
#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr char kFieldUrl[] = "patchmill/field", kCodeUrl[] = "patchmill/code",
               kLimitUrl[] = "patchmill/limit";  // "limit value name"

absl::Status With(const char* url, std::string_view value, std::string_view message) {
  absl::Status status = absl::InvalidArgumentError(std::string(message));
  status.SetPayload(url, absl::Cord(std::string(value)));
  return status;
}

std::string ValueOf(const absl::Status& status, const char* url) {
  const auto value = status.GetPayload(url);
  return value ? std::string(*value) : std::string();
}

}  // namespace

absl::Status FieldError(std::string_view field, std::string_view text) {
  return With(kFieldUrl, field, std::string(field) + " " + std::string(text));
}

std::string FieldOf(const absl::Status& status) { return ValueOf(status, kFieldUrl); }

std::string FieldText(const absl::Status& status) {
  const std::string field = FieldOf(status);
  PM_CHECK(!field.empty());
  return std::string(status.message()).substr(field.size() + 1);
}

absl::Status WithFieldPrefix(std::string_view prefix, const absl::Status& status) {
  const std::string field = FieldOf(status);
  return field.empty() ? status : FieldError(std::string(prefix) + field, FieldText(status));
}

absl::Status CodedError(std::string_view code, std::string_view message) {
  return With(kCodeUrl, code, message);
}

std::string CodeOf(const absl::Status& status) { return ValueOf(status, kCodeUrl); }

absl::Status LimitPassedError(const PassedLimit& passed, std::string_view text) {
  absl::Status status = absl::ResourceExhaustedError(
      fmt::format("{} = {:.10g}; the limit is {:.10g}: {}", passed.name, passed.value, passed.limit, text));
  status.SetPayload(kLimitUrl,
                    absl::Cord(fmt::format("{:.17g} {:.17g} {}", passed.limit, passed.value, passed.name)));
  return status;
}

std::optional<PassedLimit> LimitPassedOf(const absl::Status& status) {
  const std::string text = ValueOf(status, kLimitUrl);
  std::vector<std::string> words = absl::StrSplit(text, absl::MaxSplits(' ', 2));
  PassedLimit passed;
  if (words.size() != 3 || !absl::SimpleAtod(words[0], &passed.limit) ||
      !absl::SimpleAtod(words[1], &passed.value)) {
    return std::nullopt;
  }
  passed.name = std::move(words[2]);
  return passed;
}

}  // namespace patchmill
