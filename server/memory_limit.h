// How much memory the process may take, and how it is shared out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace patchmill {

// The limit of the control group that the process belongs to (cgroup v2 or v1), or three quarters of the
// machine's memory if there is none or it is higher. Bytes. `root` is "/" but in tests.
std::int64_t DefaultMemoryLimit(const std::string& root = "/");

// Shares of a limit on the memory of the whole process, bytes.
struct MemoryShares {
  std::int64_t limit = 0;      // what is shared out
  std::int64_t in_flight = 0;  // requests and answers
  std::int64_t store = 0;
  std::int64_t jobs = 0;  // what calls take to do their work
};

// `in_flight` and `store` are wishes, bytes; each is cut to a quarter of what the program itself leaves. The
// rest is for jobs, less a fifth of it: the allocator takes more from the system than it gives out.
MemoryShares ShareMemory(std::int64_t limit, std::int64_t in_flight, std::int64_t store);

}  // namespace patchmill
