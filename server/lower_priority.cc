#include "server/lower_priority.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <tbb/task_scheduler_observer.h>
#include <unistd.h>

namespace patchmill {
namespace {

constexpr int kNice = 10;  // of 19

class WorkerObserver : public tbb::task_scheduler_observer {
 public:
  void on_scheduler_entry(bool is_worker) override {
    static thread_local bool lowered = false;
    if (!is_worker || lowered) return;
    lowered = true;
    LowerPriorityOfThread();
  }
};

}  // namespace

void LowerPriorityOfThread() {
#if defined(__linux__)
  // On Linux a priority belongs to a thread, not to its process.
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
#endif
}

void LowerPriorityOfWorkers() {
  static auto* const observer = new WorkerObserver;  // lives as long as the process
  observer->observe(true);
}

}  // namespace patchmill
