// Files that the user names.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

namespace patchmill::cli {

inline constexpr std::size_t kMaxFileBytes = std::size_t{64} << 20;        // limit of a message on the wire
inline constexpr std::size_t kMaxModelFileBytes = std::size_t{256} << 20;  // limit of an upload

// The bytes of a file; "-" is the standard input. INVALID_ARGUMENT with the reason if it cannot be read or is
// longer than `limit`. Reading stops there.
absl::StatusOr<std::string> ReadWholeFile(const std::string& name, std::size_t limit = kMaxFileBytes);

// All paths that ReadWholeFile has read. No result replaces one of these files (output_file.h).
const std::vector<std::string>& FilesRead();

// How the service names an input (the path of a field), and the file that it came from.
struct NamedInput {
  std::string field, path;
};

// For messages about the content of the model, or points to be faired, and of the program of this command.
void NameModel(const std::string& path);
void NameProgram(const std::string& path);
const std::vector<NamedInput>& NamedInputs();

}  // namespace patchmill::cli
