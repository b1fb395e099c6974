#include "server/process_memory.h"

#include <array>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace patchmill {

std::int64_t ResidentBytes() {
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  std::array<char, 128> text{};
  const ssize_t n = read(file, text.data(), text.size() - 1);
  close(file);
  const char* second = n > 0 ? std::strchr(text.data(), ' ') : nullptr;
  if (second == nullptr) return 0;
  return std::strtoll(second, nullptr, 10) * sysconf(_SC_PAGESIZE);
}

bool ProcessHasRoom(std::int64_t bytes, std::int64_t limit_bytes) {
  const std::int64_t most = limit_bytes - limit_bytes / 16 - bytes;
  if (ResidentBytes() <= most) return true;
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
  return ResidentBytes() <= most;
}

}  // namespace patchmill
