#include "clients/cli/output_file.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "clients/cli/input_file.h"
#include "clients/cli/temporary_files.h"

namespace patchmill::cli {
namespace {

std::string Directory(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

// The file that a path leads to, through symbolic links. It need not exist. Empty if the links are a circle,
// and for an open file of a process (/dev/fd/3), which has no place of its own.
std::string Target(const std::string& path) {
  constexpr int kMostLinks = 40;  // as Linux
  std::filesystem::path target = path;
  std::error_code error;
  for (int i = 0; i < kMostLinks; ++i) {
    const auto folder = std::filesystem::weakly_canonical(Directory(target.string()), error);
    if (folder == "/proc" || absl::StartsWith(folder.string(), "/proc/")) return "";
    if (!std::filesystem::is_symlink(target, error)) return target.string();
    target = target.parent_path() / std::filesystem::read_symlink(target, error);
    if (error) return "";
  }
  return "";
}

bool IsNoFile(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode);
}

// Whether a result is written into what the path leads to, not put in its place: devices, pipes, open files.
bool IsSpecial(const std::string& path) {
  return IsNoFile(path) || (access(path.c_str(), F_OK) == 0 && Target(path).empty());
}

// Whether two paths are one regular file, which need not exist yet. Other files (pipes) may take several
// results.
bool IsSame(const std::string& a, const std::string& b) {
  if (IsNoFile(a) || IsNoFile(b)) return false;
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  const auto whole = [&error](const std::string& path) -> std::filesystem::path {
    const std::string target = Target(path);
    if (target.empty()) return {};
    const auto from_root = std::filesystem::absolute(target, error);
    return error ? std::filesystem::path() : std::filesystem::weakly_canonical(from_root, error);
  };
  const auto here = whole(a);
  return !here.empty() && here == whole(b);
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

// While this object lives, a reader that has gone is an error of write, not the end of the process.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoPipeSignal() {
    const timespec now{0, 0};
    while (sigtimedwait(&pipe_, nullptr, &now) > 0) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t pipe_, before_;
};

// Writes to the standard output, a device or a pipe. This may wait for a reader for ever.
absl::Status WriteSpecial(const OutputFile& output) {
  const NoPipeSignal no_signal;
  if (output.is_standard()) {
    std::fflush(stdout);
    return WriteAll(STDOUT_FILENO, output.bytes()) ? absl::OkStatus() : Fault("the standard output");
  }
  const int file = open(output.path().c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file < 0) return Fault(output.path());
  absl::Status fault = WriteAll(file, output.bytes()) ? absl::OkStatus() : Fault(output.path());
  if (close(file) != 0 && fault.ok()) fault = Fault(output.path());
  return fault;
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
  if (absl::Status unread = CheckNotRead(path_); !unread.ok()) return unread;
  if (IsSpecial(path_)) return access(path_.c_str(), W_OK) == 0 ? absl::OkStatus() : Fault(path_);
  const std::string target = Target(path_);
  if (target.empty()) {
    errno = ELOOP;
    return Fault(path_);
  }
  const bool may_replace = access(target.c_str(), W_OK) == 0 || errno == ENOENT;
  return may_replace && access(Directory(target).c_str(), W_OK) == 0 ? absl::OkStatus() : Fault(path_);
}

absl::Status CheckWritable(std::initializer_list<const OutputFile*> files) {
  std::vector<const OutputFile*> seen;
  for (const OutputFile* file : files) {
    if (!file->wanted()) continue;
    if (absl::Status writable = file->CheckWritable(); !writable.ok()) return writable;
    for (const OutputFile* other : seen) {
      if (file->is_standard() && other->is_standard())
        return absl::InvalidArgumentError("two results go to the standard output; give one of them a file");
      if (IsSame(file->path(), other->path()))
        return absl::InvalidArgumentError(fmt::format("{} is the output file of two results", file->path()));
    }
    seen.push_back(file);
  }
  return absl::OkStatus();
}

absl::Status Commit(std::initializer_list<const OutputFile*> files) {
  std::vector<TemporaryFile> temporary;
  absl::Status fault;
  const auto each = [&](auto write) {
    for (const OutputFile* file : files) {
      if (file->wanted() && fault.ok()) fault = write(*file);
    }
  };
  each([](const OutputFile& file) { return CheckNotRead(file.path()); });
  each([&](const OutputFile& file) {
    if (file.is_standard() || IsSpecial(file.path())) return absl::OkStatus();
    absl::StatusOr<TemporaryFile> made = WriteTemporary(Target(file.path()), file.bytes());
    if (!made.ok()) return made.status();
    temporary.push_back(*std::move(made));
    return absl::OkStatus();
  });
  each([](const OutputFile& file) {
    return file.is_standard() || IsSpecial(file.path()) ? WriteSpecial(file) : absl::OkStatus();
  });
  if (fault.ok()) return Place(temporary);
  Remove(temporary);
  return fault;
}

}  // namespace patchmill::cli
