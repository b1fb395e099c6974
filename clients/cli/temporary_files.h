// Files that wait under temporary names until all results of a command are written.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

namespace patchmill::cli {

// Writes all bytes to a descriptor. False with errno if that fails.
bool WriteAll(int file, std::string_view bytes);

// A whole file beside its target.
struct TemporaryFile {
  std::string path, target;
};

// Writes `bytes` to a new file in the folder of `target`. The file gets mode and owner of `target` if that is
// there, else the usual permissions. FAILED_PRECONDITION with the reason if that fails.
absl::StatusOr<TemporaryFile> WriteTemporary(const std::string& target, std::string_view bytes);

// Puts all files in the places of their targets. No signal comes in between. After a fault the files that are
// left are removed.
absl::Status Place(const std::vector<TemporaryFile>& files);

// Removes files that were not placed.
void Remove(const std::vector<TemporaryFile>& files);

// Removes all temporary files of this process and keeps it from writing or placing any more. The process has
// to end after that.
void RemoveAllTemporaryFiles();

}  // namespace patchmill::cli
