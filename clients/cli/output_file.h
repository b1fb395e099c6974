// Results of a command, which appear on disk whole or not at all.
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
  // An empty path means that no file is wanted, and "-" the standard output. `endings` lists the allowed
  // endings (".json"); empty allows any. The standard output takes the first one.
  explicit OutputFile(std::string path, std::vector<std::string> endings = {})
      : path_(path == "-" ? "/dev/stdout" : std::move(path)),
        endings_(std::move(endings)),
        is_standard_(path_ == "/dev/stdout") {}

  bool wanted() const { return !path_.empty(); }
  const std::string& path() const { return path_; }
  std::string_view bytes() const { return bytes_; }
  std::size_t size() const { return bytes_.size(); }
  void Append(std::string_view bytes) { bytes_ += bytes; }
  void Set(std::string bytes) { bytes_ = std::move(bytes); }

  // Whether the result is the standard output, so that nothing else may be printed there.
  bool is_standard() const { return is_standard_; }
  bool EndsIn(const std::string& ending) const {
    if (is_standard_) return !endings_.empty() && endings_.front() == ending;
    return absl::EndsWithIgnoreCase(path_, ending);
  }
  // OK if the ending is allowed, Commit can write the file, and the file is no input of this command. A file
  // that may not be written is not replaced.
  absl::Status CheckWritable() const;

 private:
  std::string path_;
  std::vector<std::string> endings_;
  bool is_standard_ = false;
  std::string bytes_;  // in memory until it is known to be good
};

// Checks the wanted files in order and stops at the first fault. Two of them must not be the same regular
// file. Call this after all inputs are read and before the job runs.
absl::Status CheckWritable(std::initializer_list<const OutputFile*> files);

// Writes the wanted files, all or none: first as temporary files beside their targets, which then take the
// places. A symbolic link stays; its target is replaced. A file that is replaced hands on its mode. What is
// no regular file (/dev/stdout, a pipe) is written directly, between the two steps. An interrupt leaves no
// temporary file (interrupt_watch.h).
absl::Status Commit(std::initializer_list<const OutputFile*> files);

}  // namespace patchmill::cli
