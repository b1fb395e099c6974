// Errors about who calls, and how much a caller may take.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include <absl/status/status.h>

namespace patchmill {

// A caller that is not known. `reason` is TOKEN_MISSING, TOKEN_UNREADABLE, TOKEN_UNKNOWN or TOKEN_EXPIRED.
absl::Status UnauthenticatedError(std::string_view reason, std::string_view message);
// A caller that has taken what it may take. The same call may succeed after `delay`; never without one.
absl::Status QuotaError(std::string_view limit, double limit_value, double actual_value,
                        std::optional<std::chrono::milliseconds> delay);

}  // namespace patchmill
