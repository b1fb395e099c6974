// What goes with an error besides its text, so that a program that asked can act on it: which field is wrong,
// a code of what is, or which limit was passed by how much.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <absl/status/status.h>

namespace patchmill {

// INVALID_ARGUMENT "<field> <text>": FieldError("heights.clearance_z_mm", "= 3; must be at least 5").
absl::Status FieldError(std::string_view field, std::string_view text);

// The field's path; empty where the status is no FieldError.
std::string FieldOf(const absl::Status& status);

// What is wrong with it: the message without the path. Only of a FieldError.
std::string FieldText(const absl::Status& status);

// The same error with `prefix` before the path; any other status as it is.
absl::Status WithFieldPrefix(std::string_view prefix, const absl::Status& status);

// INVALID_ARGUMENT with a code, UPPER_SNAKE_CASE.
absl::Status CodedError(std::string_view code, std::string_view message);

// Empty where the status has none.
std::string CodeOf(const absl::Status& status);

struct PassedLimit {
  std::string name;  // with its unit
  double limit = 0.0, value = 0.0;
};

// RESOURCE_EXHAUSTED "<name> = <value>; the limit is <limit>: <text>"; the text says what to do.
absl::Status LimitPassedError(const PassedLimit& passed, std::string_view text);

// Absent where the status is no LimitPassedError.
std::optional<PassedLimit> LimitPassedOf(const absl::Status& status);

}  // namespace patchmill
