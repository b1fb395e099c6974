// A result that appears on disk whole or not at all.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/status.h>
#include <absl/strings/match.h>

namespace patchmill::cli {

class OutputFile {
 public:
  OutputFile() = default;
  // Empty: nothing is wanted. `endings`: what the path may end in (".json"); none: anything.
  explicit OutputFile(std::string path, std::vector<std::string> endings = {})
      : path_(std::move(path)), endings_(std::move(endings)) {}

  bool wanted() const { return !path_.empty(); }
  const std::string& path() const { return path_; }
  std::size_t size() const { return bytes_.size(); }
  void Append(std::string_view bytes) { bytes_ += bytes; }
  void Set(std::string bytes) { bytes_ = std::move(bytes); }

  bool EndsIn(const std::string& ending) const { return absl::EndsWithIgnoreCase(path_, ending); }
  // Whether the ending is one of those allowed and Commit can work; no file that was read is replaced.
  absl::Status CheckWritable() const;
  // Writes under a temporary name beside the target, then renames. What is not a regular file (/dev/stdout, a
  // pipe) is written directly. On failure nothing new is left.
  absl::Status Commit() const;

 private:
  std::string path_;
  std::vector<std::string> endings_;
  std::string bytes_;  // in memory until it is known to be good
};

// Those of the files that are wanted, in order; the first fault ends it. No two may be the same regular file.
// CheckWritable is asked when all that the request needs is read, before the job costs anything.
absl::Status CheckWritable(std::initializer_list<const OutputFile*> files);
absl::Status Commit(std::initializer_list<const OutputFile*> files);

}  // namespace patchmill::cli
