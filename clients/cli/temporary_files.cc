#include "clients/cli/temporary_files.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace patchmill::cli {
namespace {

// The temporary files that are on disk. Neither is destroyed: a signal may end the process at any time.
std::mutex& Guard() {
  static auto& guard = *new std::mutex;
  return guard;
}

std::set<std::string>& Waiting() {
  static auto& waiting = *new std::set<std::string>;
  return waiting;
}

absl::Status Fault(const std::string& path) {
  return absl::FailedPreconditionError(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
}

// Opens a new file with a short name of its own in the folder of `target`.
int OpenNew(const std::string& target, std::string& path) {
  static std::atomic<int> number{0};
  const std::filesystem::path folder = std::filesystem::path(target).parent_path();
  const std::lock_guard<std::mutex> lock(Guard());
  for (int tries = 0; tries < 1000; ++tries) {
    path = (folder / fmt::format(".patchmill-{}-{}", getpid(), ++number)).string();
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) Waiting().insert(path);
    if (file >= 0 || errno != EEXIST) return file;
  }
  return -1;
}

// Gives a file the mode of its target, and the owner as far as this process may.
bool TakeMode(int file, const std::string& target) {
  struct stat there {
  }, here{};
  if (stat(target.c_str(), &there) != 0) return true;
  if (fstat(file, &here) != 0) return false;
  const bool same_owner = here.st_uid == there.st_uid && here.st_gid == there.st_gid;
  if (!same_owner && fchown(file, there.st_uid, there.st_gid) != 0 && errno != EPERM) return false;
  return fchmod(file, there.st_mode & 0777) == 0;
}

void RemoveLocked(const std::string& path) {
  unlink(path.c_str());
  Waiting().erase(path);
}

}  // namespace

bool WriteAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(file, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

absl::StatusOr<TemporaryFile> WriteTemporary(const std::string& target, std::string_view bytes) {
  TemporaryFile temporary{.path = {}, .target = target};
  const int file = OpenNew(target, temporary.path);
  if (file < 0) return Fault(target);
  const bool written = WriteAll(file, bytes) && TakeMode(file, target) && fsync(file) == 0;
  absl::Status fault = written ? absl::OkStatus() : Fault(target);
  if (close(file) != 0 && fault.ok()) fault = Fault(target);
  if (fault.ok()) return temporary;
  Remove({temporary});
  return fault;
}

absl::Status Place(const std::vector<TemporaryFile>& files) {
  const std::lock_guard<std::mutex> lock(Guard());
  absl::Status fault;
  for (const TemporaryFile& file : files) {
    if (fault.ok() && rename(file.path.c_str(), file.target.c_str()) == 0) {
      Waiting().erase(file.path);
      continue;
    }
    if (fault.ok()) fault = Fault(file.target);
    RemoveLocked(file.path);
  }
  return fault;
}

void Remove(const std::vector<TemporaryFile>& files) {
  const std::lock_guard<std::mutex> lock(Guard());
  for (const TemporaryFile& file : files) RemoveLocked(file.path);
}

void RemoveAllTemporaryFiles() {
  Guard().lock();  // for ever, so that nothing is written or placed any more
  for (const std::string& path : Waiting()) unlink(path.c_str());
}

}  // namespace patchmill::cli
