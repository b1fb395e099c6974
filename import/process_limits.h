// What the importer may not do: it reads files of strangers with a large library.
#pragma once

#include <cstddef>

namespace patchmill {

struct ProcessLimits {
  std::size_t memory_bytes = std::size_t{2} << 30;
  int cpu_seconds = 60;
};

// Limits memory, processor time, files and core dumps of this process, gives up the right to gain privileges,
// and has it killed when its parent ends. False where the system refuses one of them.
bool LimitThisProcess(const ProcessLimits& limits);

}  // namespace patchmill
