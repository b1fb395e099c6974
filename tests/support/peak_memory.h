// How much memory a test has needed.
#pragma once

#include <fstream>
#include <string>

namespace patchmill::testing {

// High-water mark of this process, MB; 0 where the system does not tell.
inline double PeakMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmHWM:") {
      double kilobytes = 0.0;
      status >> kilobytes;
      return kilobytes / 1024.0;
    }
  }
  return 0.0;
}

}  // namespace patchmill::testing
