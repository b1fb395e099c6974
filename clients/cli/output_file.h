// A result that appears on disk whole or not at all.
#pragma once

#include <string>
#include <string_view>

#include <absl/status/status.h>

namespace patchmill::cli {

class OutputFile {
 public:
  OutputFile() = default;
  explicit OutputFile(std::string path) : path_(std::move(path)) {}

  bool wanted() const { return !path_.empty(); }
  const std::string& path() const { return path_; }
  std::size_t size() const { return bytes_.size(); }
  void Append(std::string_view bytes) { bytes_ += bytes; }
  void Set(std::string bytes) { bytes_ = std::move(bytes); }

  // Whether Commit can work, asked before the job costs anything.
  absl::Status CheckWritable() const;
  // Writes under a temporary name beside the target, then renames. What is not a regular file (/dev/stdout, a
  // pipe) is written directly. On failure nothing new is left.
  absl::Status Commit() const;

 private:
  std::string path_;
  std::string bytes_;  // in memory until it is known to be good
};

}  // namespace patchmill::cli
