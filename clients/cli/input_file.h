// Files the user names.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

namespace patchmill::cli {

inline constexpr std::size_t kMaxFileBytes = std::size_t{64} << 20;  // the contract's limit of a message

// INVALID_ARGUMENT with the reason when it cannot be read, or is longer than that; no more is read.
absl::StatusOr<std::string> ReadWholeFile(const std::string& path);

// All that it was asked for: no result replaces one of them (output_file.h).
const std::vector<std::string>& FilesRead();

}  // namespace patchmill::cli
