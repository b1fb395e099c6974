#include "server/memory_limit.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string_view>

namespace patchmill {
namespace {

constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();

// The number in a file of one line; kNone for "max" and where there is no such file.
std::int64_t NumberIn(const std::string& path) {
  std::ifstream file(path);
  std::int64_t number = 0;
  return file >> number && number > 0 ? number : kNone;
}

// Path of the control group in /proc/self/cgroup: of cgroup v2 ("0::/a/b") or of the memory controller of v1.
std::string GroupIn(const std::string& path, std::string_view controller) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    if (line.substr(first + 1, second - first - 1) == controller) return line.substr(second + 1);
  }
  return {};
}

// The smallest limit of the group and of those that it lies in.
std::int64_t LimitOfGroup(const std::string& mount, std::string group, const std::string& file) {
  std::int64_t limit = NumberIn(mount + "/" + file);
  while (group.size() > 1) {
    limit = std::min(limit, NumberIn(mount + group + "/" + file));
    group.resize(group.rfind('/'));
  }
  return limit;
}

std::int64_t MachineMemory(const std::string& path) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("MemTotal:")) return std::atoll(line.c_str() + 9) << 10;
  }
  return kNone;
}

}  // namespace

std::int64_t DefaultMemoryLimit(const std::string& root) {
  const std::string self = root + "/proc/self/cgroup", mount = root + "/sys/fs/cgroup";
  const std::int64_t group =
      std::min(LimitOfGroup(mount, GroupIn(self, ""), "memory.max"),
               LimitOfGroup(mount + "/memory", GroupIn(self, "memory"), "memory.limit_in_bytes"));
  const std::int64_t machine = MachineMemory(root + "/proc/meminfo");
  if (machine == kNone) return group == kNone ? std::int64_t{4} << 30 : group;
  return std::min(group, machine / 4 * 3);
}

MemoryShares ShareMemory(std::int64_t limit, std::int64_t in_flight, std::int64_t store) {
  constexpr std::int64_t kProgram = std::int64_t{64} << 20;  // the program, its threads and gRPC
  const std::int64_t rest = std::max<std::int64_t>(limit - kProgram, 0);
  MemoryShares shares{.limit = limit};
  shares.in_flight = std::min(in_flight, rest / 4);
  shares.store = std::min(store, rest / 4);
  shares.jobs = (rest - shares.in_flight - shares.store) / 5 * 4;
  return shares;
}

}  // namespace patchmill
