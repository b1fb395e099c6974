// Counts of the whole process, for places that belong to no call.
#pragma once

#include <atomic>
#include <cstdint>

namespace patchmill {

struct ProcessCounts {
  std::atomic<std::uint64_t> failed_imports{0};     // CAD files that the importer could not read
  std::atomic<std::uint64_t> failed_handshakes{0};  // of TLS
};

// Since the start of the process.
inline ProcessCounts& Counts() {
  static ProcessCounts counts;
  return counts;
}

}  // namespace patchmill
