#include "server/importer.h"

#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error_details.h"
#include "core/base/frames.h"
#include "core/base/status.h"
#include "server/errors.h"
#include "server/limits.h"
#include "server/wire_count.h"
#include "server/wire_limits.h"

namespace patchmill {
namespace {

constexpr int kPollMs = 20;

// A file descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() { Close(); }
  int get() const { return fd_; }
  void Close() {
    if (fd_ >= 0) close(fd_);
    fd_ = -1;
  }

 private:
  int fd_;
};

absl::Status NoResources(std::string_view what) {
  return absl::ResourceExhaustedError(
      fmt::format("the CAD importer could not be started: {}: {}", what, std::strerror(errno)));
}

absl::Status NotBuilt(std::string_view path) {
  return absl::UnimplementedError(fmt::format(
      "this installation reads no STEP or IGES: the importer {} is missing; install it, or send the "
      "model as .json or .pb",
      path));
}

// The bytes as a file without a name.
absl::StatusOr<Descriptor> MemoryFile(std::string_view content) {
  Descriptor file(memfd_create("model", MFD_CLOEXEC));
  if (file.get() < 0) return NoResources("memory file");
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t wrote = write(file.get(), content.data() + done, content.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return NoResources("memory file");
    done += static_cast<std::size_t>(wrote);
  }
  lseek(file.get(), 0, SEEK_SET);
  return file;
}

// A running importer. It is killed and waited for at the end, unless it has ended by itself.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (pid_ <= 0) return;
    kill(-pid_, SIGKILL);  // with all that it has started
    kill(pid_, SIGKILL);
    Wait();
  }
  // The status if it ends within a second; else it is killed.
  absl::StatusOr<int> WaitSoon(const RunContext& run) {
    for (int round = 0; round < 50; ++round) {
      int status = 0;
      if (waitpid(pid_, &status, WNOHANG) == pid_) {
        pid_ = -1;
        return status;
      }
      if (absl::Status over = run.Check(); !over.ok()) return over;
      std::this_thread::sleep_for(std::chrono::milliseconds(kPollMs));
    }
    kill(-pid_, SIGKILL);
    kill(pid_, SIGKILL);
    return Wait();
  }
  // The status of waitpid.
  int Wait() {
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return status;
  }

 private:
  pid_t pid_;
};

struct Started {
  pid_t pid = -1;
  Descriptor answers;
};

// The command line of the importer.
std::vector<std::string> ArgumentsOf(const std::string& program, const ImportParams& params) {
  std::vector<std::string> arguments = {program, "--format", std::string(params.format)};
  if (params.border_tolerance) {
    arguments.insert(arguments.end(), {"--border-tolerance", fmt::format("{}", *params.border_tolerance)});
  }
  for (const std::string& id : params.skipped) arguments.insert(arguments.end(), {"--skip-face", id});
  return arguments;
}

absl::StatusOr<Started> Start(const std::string& program, const ImportParams& params, int input) {
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return NoResources("pipe");
  Descriptor reading(ends[0]), writing(ends[1]);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, 0);
  posix_spawn_file_actions_adddup2(&actions, writing.get(), 1);
  posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addclosefrom_np(&actions, 3);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::vector<std::string> arguments = ArgumentsOf(program, params);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  // The reader must not see another locale, and its arithmetic must not depend on the processor.
  std::string locale = "LC_ALL=C",
              tunables = "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA,-FMA4";
  char* environment[] = {locale.data(), tunables.data(), nullptr};
  pid_t pid = -1;
  const int failed = posix_spawn(&pid, program.c_str(), &actions, &attributes, argv.data(), environment);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failed != 0) {
    errno = failed;
    return NoResources(program);
  }
  return Started{pid, std::move(reading)};
}

// A progress frame's text: "0.25 trim.fit".
void Report(std::string_view text, const RunContext& run) {
  const std::size_t space = text.find(' ');
  double fraction = 0.0;
  if (space == std::string_view::npos) return;
  if (std::from_chars(text.data(), text.data() + space, fraction).ec != std::errc()) return;
  if (!(fraction >= 0.0 && fraction <= 1.0)) return;
  run.Progress("import", fraction);
}

absl::Status ImporterError(std::string_view text) {
  const std::size_t space = text.find(' ');
  const std::string_view code = text.substr(0, space);
  const std::string sentence = Utf8(space == std::string_view::npos ? text : text.substr(space + 1));
  if (code == "IMPORT_LIMIT") return absl::ResourceExhaustedError(sentence);
  if (code == "UNKNOWN_FACE") return CodedError(code, sentence);
  return ModelUnreadableError(fmt::format("CAD file: {}", sentence), Utf8(code));
}

// The message in a result frame.
absl::StatusOr<Imported> ParseResult(std::string_view content, InFlight* in_flight) {
  google::protobuf::io::ArrayInputStream stream(content.data(), static_cast<int>(content.size()));
  PM_ASSIGN_OR_RETURN(const WireCount count,
                      CountWire(stream, content.size(), *v1::ImportResult::descriptor(),
                                ListLimits(limits::kMaxFileModelBytes)));
  Imported imported;
  if (in_flight != nullptr) {
    PM_ASSIGN_OR_RETURN(imported.held, in_flight->Take(count.memory_bytes + content.size()));
  }
  if (!imported.result.ParseFromArray(content.data(), static_cast<int>(content.size()))) {
    return ModelUnreadableError("CAD file: the importer's answer is no message", "IMPORTER_DIED");
  }
  return imported;
}

absl::Status DeathOf(int status, std::string_view format) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    return absl::ResourceExhaustedError("reading the CAD file took too long");
  }
  const std::string how = WIFSIGNALED(status) ? fmt::format("signal {}", WTERMSIG(status))
                                              : fmt::format("exit status {}", WEXITSTATUS(status));
  return ModelUnreadableError(fmt::format("CAD file: the {} reader failed on this file ({})", format, how),
                              "IMPORTER_DIED");
}

}  // namespace

std::string_view CadFormat(std::string_view ending) {
  std::string lower(ending);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (lower == "step" || lower == "stp" || lower == "p21") return "step";
  if (lower == "iges" || lower == "igs") return "iges";
  return {};
}

std::string ImporterPath() {
  std::error_code error;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", error);
  // Beside the running program; test programs lie in a folder beside that of the programs.
  const std::string beside = (own.parent_path() / "patchmill-import").string();
  if (access(beside.c_str(), X_OK) == 0) return beside;
  const std::string in_bin = (own.parent_path().parent_path() / "bin" / "patchmill-import").string();
  return access(in_bin.c_str(), X_OK) == 0 ? in_bin : beside;
}

absl::StatusOr<Imported> ImportFile(std::string_view content, const ImportParams& params,
                                    const RunContext& run, InFlight* in_flight) {
  return ImportFileWith(ImporterPath(), content, params, run, in_flight);
}

absl::StatusOr<Imported> ImportFileWith(const std::string& program, std::string_view content,
                                        const ImportParams& params, const RunContext& run,
                                        InFlight* in_flight) {
  if (access(program.c_str(), X_OK) != 0) return NotBuilt(program);
  PM_ASSIGN_OR_RETURN(const Descriptor input, MemoryFile(content));
  PM_ASSIGN_OR_RETURN(Started started, Start(program, params, input.get()));
  Child child(started.pid);
  std::string bytes;
  std::array<char, 1 << 16> block;
  while (true) {
    PM_RETURN_IF_ERROR(run.Check());
    pollfd waiting{started.answers.get(), POLLIN, 0};
    if (poll(&waiting, 1, kPollMs) <= 0) continue;
    const ssize_t got = read(started.answers.get(), block.data(), block.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    bytes.append(block.data(), static_cast<std::size_t>(got));
    if (bytes.size() > limits::kMaxFileModelBytes) {
      return LimitError("import.result_bytes", static_cast<double>(limits::kMaxFileModelBytes),
                        static_cast<double>(bytes.size()));
    }
    std::string_view rest = bytes;
    for (Frame frame; TakeFrame(rest, frame);) {
      if (frame.kind == FrameKind::kProgress) {
        Report(frame.content, run);
      } else if (frame.kind == FrameKind::kResult) {
        return ParseResult(frame.content, in_flight);
      } else {
        return ImporterError(frame.content);
      }
    }
    bytes.erase(0, bytes.size() - rest.size());
  }
  PM_ASSIGN_OR_RETURN(const int status, child.WaitSoon(run));
  return DeathOf(status, params.format);
}

std::string ImporterStamp() {
  const std::string importer = ImporterPath();
  std::error_code missing;
  const auto written = std::filesystem::last_write_time(importer, missing);
  return missing ? std::string() : fmt::format("{} {}", importer, written.time_since_epoch().count());
}

}  // namespace patchmill
