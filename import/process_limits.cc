#include "import/process_limits.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace patchmill {

bool LimitThisProcess(const ProcessLimits& limits) {
  const auto limit = [](int resource, rlim_t soft, rlim_t hard) {
    const rlimit both{soft, hard};
    return setrlimit(static_cast<__rlimit_resource>(resource), &both) == 0;
  };
  const auto seconds = static_cast<rlim_t>(limits.cpu_seconds);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  const bool memory = true;  // a sanitizer's shadow takes terabytes of addresses
#else
  const bool memory = limit(RLIMIT_AS, limits.memory_bytes, limits.memory_bytes);
#endif
  return memory && limit(RLIMIT_CPU, seconds, seconds + 2) &&  // SIGXCPU, then SIGKILL
         limit(RLIMIT_CORE, 0, 0) && limit(RLIMIT_FSIZE, limits.memory_bytes, limits.memory_bytes) &&
         limit(RLIMIT_NOFILE, 32, 32) && prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0) == 0 && chdir("/") == 0;
}

}  // namespace patchmill
