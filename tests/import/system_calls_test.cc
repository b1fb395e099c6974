// What the importer may ask of the system, asked by a child that is limited as it is.
#include "import/system_calls.h"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <iterator>
#include <optional>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace patchmill {
namespace {

// Runs `body` in a child whose system calls are limited. Returns its exit status; nullopt where this build
// or this kernel does not limit them.
std::optional<int> Limited(int (*body)()) {
  constexpr int kNotLimited = 100, kFailed = 101;
  const pid_t child = fork();
  if (child == 0) {
    const SystemCalls calls = LimitSystemCalls();
    if (calls != SystemCalls::kLimited) _exit(calls == SystemCalls::kFailed ? kFailed : kNotLimited);
    _exit(body());
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status)) << status;
  EXPECT_NE(WEXITSTATUS(status), kFailed);
  if (WEXITSTATUS(status) == kNotLimited) return std::nullopt;
  return WEXITSTATUS(status);
}

int ErrorOf(long result) { return result < 0 ? errno : 0; }

TEST(LimitSystemCalls, RefusesWhatReadingDoesNotTake) {
  constexpr int (*kRefused[])() = {
      +[] { return ErrorOf(socket(AF_INET, SOCK_STREAM, 0)); },
      +[] { return ErrorOf(socket(AF_UNIX, SOCK_STREAM, 0)); },
      +[] { return ErrorOf(fork()); },
      +[] {
        char name[] = "/bin/true";
        char* arguments[] = {name, nullptr};
        return ErrorOf(execv(name, arguments));
      },
      +[] { return ErrorOf(open("/tmp/patchmill_system_calls_test", O_WRONLY | O_CREAT, 0600)); },
      +[] { return ErrorOf(open("/dev/null", O_RDWR)); },
      +[] { return ErrorOf(unlink("/tmp/patchmill_system_calls_test")); },
      +[] { return ErrorOf(kill(getppid(), 0)); },
      +[] { return ErrorOf(setuid(getuid())); },
      +[] { return ErrorOf(chdir("/tmp")); },
  };
  for (std::size_t k = 0; k < std::size(kRefused); ++k) {
    const std::optional<int> error = Limited(kRefused[k]);
    if (!error) GTEST_SKIP() << "system calls are not limited here";
    EXPECT_EQ(*error, EPERM) << k;
  }
}

TEST(LimitSystemCalls, LeavesWhatReadingTakes) {
  constexpr int (*kLeft[])() = {
      +[] { return ErrorOf(open("/etc/passwd", O_RDONLY | O_CLOEXEC)); },
      +[] { return ErrorOf(memfd_create("part", 0)); },
      +[] {
        void* const block =
            mmap(nullptr, 1 << 20, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        return block == MAP_FAILED ? errno : ErrorOf(munmap(block, 1 << 20));
      },
      +[] { return ErrorOf(write(STDERR_FILENO, "", 0)); },
  };
  for (std::size_t k = 0; k < std::size(kLeft); ++k) {
    const std::optional<int> error = Limited(kLeft[k]);
    if (!error) GTEST_SKIP() << "system calls are not limited here";
    EXPECT_EQ(*error, 0) << k;
  }
}

}  // namespace
}  // namespace patchmill
