#include "clients/cli/output_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "clients/cli/input_file.h"

namespace patchmill::cli {
namespace {

std::string Directory(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

bool IsSpecial(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode);
}

// Whether two paths are one regular file, which need not exist yet. Other files (pipes) may take several
// results.
bool IsSame(const std::string& a, const std::string& b) {
  if (IsSpecial(a) || IsSpecial(b)) return false;
  std::error_code no_file, no_path;
  if (std::filesystem::equivalent(a, b, no_file)) return true;
  const auto whole = [&](const std::string& path) {
    const auto from_root = std::filesystem::absolute(path, no_path);
    return no_path ? std::filesystem::path() : std::filesystem::weakly_canonical(from_root, no_path);
  };
  const auto here = whole(a), there = whole(b);
  return !no_path && here == there;
}

absl::Status CheckNotRead(const std::string& path) {
  for (const std::string& input : FilesRead()) {
    if (IsSame(path, input))
      return absl::InvalidArgumentError(fmt::format("{} is an input; the result would replace it", path));
  }
  return absl::OkStatus();
}

absl::Status Fault(const std::string& path) {
  return absl::FailedPreconditionError(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
}

bool WriteAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(file, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

// mkstemp makes files that only their owner can read. A result gets the usual permissions.
mode_t UsualMode() {
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

}  // namespace

absl::Status OutputFile::CheckWritable() const {
  if (!endings_.empty() &&
      std::none_of(endings_.begin(), endings_.end(), [&](const std::string& e) { return EndsIn(e); })) {
    return absl::InvalidArgumentError(fmt::format("{}; must end in {}", path_, fmt::join(endings_, " or ")));
  }
  if (is_standard_) return absl::OkStatus();
  std::error_code ignored;
  if (std::filesystem::is_directory(path_, ignored)) {
    return absl::InvalidArgumentError(fmt::format("{} is a directory", path_));
  }
  if (const absl::Status unread = CheckNotRead(path_); !unread.ok()) return unread;
  const std::string target = IsSpecial(path_) ? path_ : Directory(path_);
  return access(target.c_str(), W_OK) == 0 ? absl::OkStatus() : Fault(path_);
}

absl::Status OutputFile::Commit() const {
  if (const absl::Status unread = CheckNotRead(path_); !unread.ok()) return unread;
  if (is_standard_) {
    std::fflush(stdout);
    return WriteAll(STDOUT_FILENO, bytes_) ? absl::OkStatus() : Fault("the standard output");
  }
  if (IsSpecial(path_)) {
    const int file = open(path_.c_str(), O_WRONLY);
    if (file < 0) return Fault(path_);
    const bool written = WriteAll(file, bytes_);
    return close(file) == 0 && written ? absl::OkStatus() : Fault(path_);
  }
  std::string temporary = path_ + ".XXXXXX";
  const int file = mkstemp(temporary.data());
  if (file < 0) return Fault(path_);
  const bool written = WriteAll(file, bytes_) && fchmod(file, UsualMode()) == 0 && fsync(file) == 0;
  if (close(file) == 0 && written && rename(temporary.c_str(), path_.c_str()) == 0) return absl::OkStatus();
  const absl::Status fault = Fault(path_);
  unlink(temporary.c_str());
  return fault;
}

absl::Status CheckWritable(std::initializer_list<const OutputFile*> files) {
  std::vector<const OutputFile*> seen;
  for (const OutputFile* file : files) {
    if (!file->wanted()) continue;
    if (const absl::Status writable = file->CheckWritable(); !writable.ok()) return writable;
    for (const OutputFile* other : seen) {
      if (IsSame(file->path(), other->path()))
        return absl::InvalidArgumentError(fmt::format("{} is the output file of two results", file->path()));
    }
    seen.push_back(file);
  }
  return absl::OkStatus();
}

absl::Status Commit(std::initializer_list<const OutputFile*> files) {
  for (const OutputFile* file : files) {
    if (!file->wanted()) continue;
    if (const absl::Status written = file->Commit(); !written.ok()) return written;
  }
  return absl::OkStatus();
}

}  // namespace patchmill::cli
