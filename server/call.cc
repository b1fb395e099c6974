#include "server/call.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <thread>

#include <fmt/format.h>

#include "server/limits.h"

namespace patchmill {
namespace {

using Clock = RunContext::Clock;

// The newest progress and the result. The worker thread writes them, the thread of the call reads them.
struct Board {
  std::mutex mutex;
  std::condition_variable changed;
  std::string stage;
  double fraction = 0.0;
  bool done = false;
  absl::Status status;
};

absl::Status Guarded(const std::function<absl::Status(const RunContext&)>& work, const RunContext& run) {
  try {
    return work(run);
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("the job needs more memory than there is");
  } catch (const std::exception& e) {
    return absl::InternalError(fmt::format("unexpected: {}", e.what()));
  }
}

int Threads(int server, int request) {
  const int most = server > 0 ? server : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return std::min({request > 0 ? request : most, most, limits::kMaxThreads});
}

Clock::time_point Deadline(const Call& call) {
  const Clock::time_point own =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(call.env->options.max_job_seconds));
  return call.deadline ? std::min(own, *call.deadline) : own;
}

// The thread that works. An exception in the one that talks cancels it, and waits for its end.
class WorkerGuard {
 public:
  template <class Body>
  WorkerGuard(RunContext& run, Body body) : run_(run), thread_(std::move(body)) {}
  WorkerGuard(const WorkerGuard&) = delete;
  WorkerGuard& operator=(const WorkerGuard&) = delete;
  ~WorkerGuard() {
    if (!thread_.joinable()) return;
    run_.Cancel();
    thread_.join();
  }
  void Join() { thread_.join(); }

 private:
  RunContext& run_;
  std::thread thread_;
};

}  // namespace

absl::Status RunJobThread(const Call& call, int max_threads, const Beat& beat,
                          const std::function<absl::Status(const RunContext&)>& work) {
  Board board;
  RunContext run(Threads(call.env->options.threads, max_threads));
  run.set_deadline(Deadline(call));
  run.set_progress([&board](std::string_view stage, double fraction) {
    const std::lock_guard<std::mutex> lock(board.mutex);
    board.stage = stage;
    board.fraction = std::clamp(fraction, 0.0, 1.0);
  });
  WorkerGuard worker(run, [&] {
    absl::Status status = Guarded(work, run);
    const std::lock_guard<std::mutex> lock(board.mutex);
    board.status = std::move(status);
    board.done = true;
    board.changed.notify_all();
  });

  Clock::time_point next_beat = Clock::now() + std::chrono::milliseconds(limits::kHeartbeatMs);
  std::unique_lock<std::mutex> lock(board.mutex);
  while (!board.done) {
    board.changed.wait_for(lock, std::chrono::milliseconds(limits::kCancelPollMs));
    if (board.done) break;
    if (call.cancelled()) run.Cancel();
    if (!beat || run.Cancelled() || Clock::now() < next_beat) continue;
    next_beat = Clock::now() + std::chrono::milliseconds(limits::kHeartbeatMs);
    const std::string stage = board.stage;
    const double fraction = board.fraction;
    lock.unlock();  // a slow reader must not delay the work
    if (!beat(stage, fraction)) run.Cancel();
    lock.lock();
  }
  lock.unlock();
  worker.Join();
  // A cancel counts even if the work finished at the same time.
  if (call.cancelled()) run.Cancel();
  const absl::Status late = run.Check();
  return late.ok() ? board.status : late;
}

absl::Status CheckThreads(int max_threads, std::string_view field) {
  if (max_threads >= 0 && max_threads <= limits::kMaxThreads) return absl::OkStatus();
  FieldErrors errors;
  errors.Add(std::string(field), fmt::format("= {}; must be in [0, {}]", max_threads, limits::kMaxThreads));
  return errors.ToStatus();
}

const char* ServerVersion() { return PATCHMILL_VERSION; }

}  // namespace patchmill
