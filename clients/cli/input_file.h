// Files the user names.
#pragma once

#include <string>

#include <absl/status/statusor.h>

namespace patchmill::cli {

// INVALID_ARGUMENT with the reason when it cannot be read.
absl::StatusOr<std::string> ReadWholeFile(const std::string& path);

}  // namespace patchmill::cli
