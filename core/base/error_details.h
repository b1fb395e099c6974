// Details that an error carries besides its text, so that the calling program can act on them: the field that
// is wrong, a code of the error, or the limit that was passed and by how much.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <absl/status/status.h>

namespace patchmill {

// INVALID_ARGUMENT "<field> <text>": FieldError("heights.clearance_z_mm", "= 3; must be at least 5").
absl::Status FieldError(std::string_view field, std::string_view text);

// The field's path; empty if the status is no FieldError.
std::string FieldOf(const absl::Status& status);

// The message of a FieldError without the path. The status must be a FieldError.
std::string FieldText(const absl::Status& status);

// The same error with `prefix` before the path. Any other status comes back unchanged.
absl::Status WithFieldPrefix(std::string_view prefix, const absl::Status& status);

// INVALID_ARGUMENT with a code in UPPER_SNAKE_CASE.
absl::Status CodedError(std::string_view code, std::string_view message);

// The code of a CodedError; empty if the status has none.
std::string CodeOf(const absl::Status& status);

struct PassedLimit {
  std::string name;  // with its unit
  double limit = 0.0, value = 0.0;
};

// RESOURCE_EXHAUSTED "<name> = <value>; the limit is <limit>: <text>". The text says what to do.
absl::Status LimitPassedError(const PassedLimit& passed, std::string_view text);

// Absent if the status is no LimitPassedError.
std::optional<PassedLimit> LimitPassedOf(const absl::Status& status);

}  // namespace patchmill
