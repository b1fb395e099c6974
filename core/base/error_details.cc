#include "core/base/error_details.h"

#include <absl/strings/cord.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr char kFieldUrl[] = "patchmill/field", kCodeUrl[] = "patchmill/code";

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

}  // namespace patchmill
