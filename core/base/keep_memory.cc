#include "core/base/keep_memory.h"

#include <algorithm>
#include <cstdlib>
#include <thread>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace patchmill {

void KeepFreedMemory() {
#if defined(__GLIBC__)
  // Both are set, because setting either one stops glibc from raising both when large arrays are freed
  // (mallopt(3)).
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 128 << 20);
  // By default there are eight arenas a core, and each keeps what a thread has freed once.
  mallopt(M_ARENA_MAX, static_cast<int>(std::max(2u, std::thread::hardware_concurrency())));
#endif
}

}  // namespace patchmill
